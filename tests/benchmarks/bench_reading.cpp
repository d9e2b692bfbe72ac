// Reading a shell mesh of one million nodes: MB/s of the file, the time as a ratio to a bare scan of its numbers
// (std::from_chars over every word, in the same run), and the peak of memory as a ratio to what is kept.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "fem/formats/gmsh.hpp"
#include "fem/formats/nastran.hpp"
#include "tests/benchmarks/reading.hpp"

using namespace tenon;
using benchmarks::ScratchFile;

namespace {

constexpr int side = 1000;  // nodes a side

/// A curved sheet.
template <class Write>
void each_node(Write write) {
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = 1.234567890123 * i / (side - 1), y = 0.9876543210987 * j / (side - 1);
      write(j * side + i + 1, x, y, std::sin(3.0 * x) * std::cos(2.0 * y));
    }
}

template <class Write>
void each_quad(Write write) {
  int number = 0;
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      const int a = j * side + i + 1;
      write(++number, a, a + 1, a + side + 1, a + side);
    }
}

void write_msh(const std::filesystem::path& path) {
  auto out = fmt::output_file(path.string());
  out.print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"skin\"\n$EndPhysicalNames\n");
  out.print("$Nodes\n{}\n", side * side);
  each_node([&](int n, double x, double y, double z) { out.print("{} {:.16g} {:.16g} {:.16g}\n", n, x, y, z); });
  out.print("$EndNodes\n$Elements\n{}\n", (side - 1) * (side - 1));
  each_quad([&](int n, int a, int b, int c, int d) { out.print("{} 3 2 1 1 {} {} {} {}\n", n, a, b, c, d); });
  out.print("$EndElements\n");
}

void write_bdf(const std::filesystem::path& path) {
  auto out = fmt::output_file(path.string());
  out.print("CEND\nBEGIN BULK\nPARAM,COUPMASS,1\nMAT1,1,7.+10,,.3,2700.\nPSHELL,1,1,.002,1,,1\n");
  each_node([&](int n, double x, double y, double z) {
    out.print("GRID    {:8d}        {:8.6f}{:8.6f}{:8.5f}\n", n, x, y, z);
  });
  each_quad([&](int n, int a, int b, int c, int d) {
    out.print("CQUAD4  {:8d}{:8d}{:8d}{:8d}{:8d}{:8d}\n", n, 1, a, b, c, d);
  });
  out.print("ENDDATA\n");
}

double bytes(const fem::Mesh& mesh) {
  std::size_t n = mesh.points.capacity() * sizeof(fem::Vec3) + mesh.point_ids.capacity() * sizeof(long);
  for (const fem::CellBlock& block : mesh.cells)
    n += block.nodes.capacity() * sizeof(int) + block.ids.capacity() * sizeof(long);
  for (const auto& [name, blocks] : mesh.cell_sets)
    for (const auto& block : blocks) n += block.capacity() * sizeof(int);
  return static_cast<double>(n);
}

double bytes(const fem::NastranDeck& deck) {
  return bytes(deck.mesh) + static_cast<double>(deck.model.nodes.capacity() * sizeof(fem::Vec3) +
                                                deck.model.node_ids.capacity() * sizeof(long) +
                                                deck.model.elements.capacity() * sizeof(fem::Element));
}

template <class Read>
void read_million_nodes(benchmark::State& state, void (*write)(const std::filesystem::path&), const char* name,
                        Read read) {
  const ScratchFile file(name);
  write(file.path());
  const double size = static_cast<double>(std::filesystem::file_size(file.path()));
  double memory = 0.0, seconds = 0.0, scan = 0.0;
  for (auto _ : state) {
    scan += benchmarks::scan_seconds(file.path());
    const benchmarks::PeakMemory peak;
    const auto start = std::chrono::steady_clock::now();
    const auto content = read(file.path());
    seconds += benchmarks::seconds_since(start);
    memory = std::max(memory, peak.rise() / bytes(content));
  }
  state.counters["of_scan"] = seconds / scan;
  state.counters["peak_of_kept"] = memory;
  state.counters["MB_per_s"] = 1e-6 * size * static_cast<double>(state.iterations()) / seconds;
}

void read_msh(benchmark::State& state) {
  read_million_nodes(state, write_msh, "sheet.msh", [](const auto& path) { return fem::read_gmsh(path); });
}

void read_bdf(benchmark::State& state) {
  read_million_nodes(state, write_bdf, "sheet.bdf", [](const auto& path) { return fem::read_nastran(path); });
}

}  // namespace

BENCHMARK(read_msh)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK(read_bdf)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK_MAIN();
