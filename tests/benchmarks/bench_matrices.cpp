// Reading K and M of other programs, 98 304 dofs of a grid of solids with 27 neighbours a node: MB/s of the files, the
// time as a ratio to a bare scan of their numbers in the same run (text alone), and the peak of memory as a ratio to
// the content: 12 bytes an entry, in both triangles where the format holds both.
#include <fmt/os.h>

#include <fstream>

#include "fem/formats/matrices/abaqus.hpp"
#include "fem/formats/matrices/calculix.hpp"
#include "fem/formats/matrices/dmig.hpp"
#include "fem/formats/matrices/matrix_market.hpp"
#include "fem/formats/matrices/op4.hpp"
#include "tests/benchmarks/reading.hpp"

using namespace tenon;
using benchmarks::ScratchFile;

namespace {

constexpr int side = 32, nodes = side * side * side, dofs = 3 * nodes;

/// Calls write(row, column, value), from 0 on, column by column in rising rows.
template <class Write>
void each_entry(bool both_triangles, Write write) {
  for (int a = 0; a < nodes; ++a)
    for (int d = 0; d < 3; ++d)
      for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int x = a % side + dx, y = a / side % side + dy, z = a / side / side + dz;
            if (x < 0 || y < 0 || z < 0 || x >= side || y >= side || z >= side) continue;
            const int b = (z * side + y) * side + x;
            for (int e = 0; e < 3; ++e) {
              const int row = 3 * b + e, column = 3 * a + d;
              const bool lower = row >= column;
              if (!lower && !both_triangles) continue;
              const int i = lower ? row : column, j = lower ? column : row;
              write(row, column, i == j ? 1e5 + i : -1234.56789012345 / (1.0 + 0.37 * (i - j) + 1e-3 * (i % 11)));
            }
          }
}

long count_entries(bool both_triangles) {
  long count = 0;
  each_entry(both_triangles, [&](int, int, double) { ++count; });
  return count;
}

/// A folder of files of this run.
struct Files {
  ScratchFile folder{"matrices"};
  Files() { std::filesystem::create_directories(folder.path()); }
  std::filesystem::path operator()(const char* name) const { return folder.path() / name; }
  double size(const char* name) const { return static_cast<double>(std::filesystem::file_size((*this)(name))); }
};

/// @param text  the file of numbers, read twice: as K and as M
template <class Read>
void measure(benchmark::State& state, const Files& files, const char* matrix, bool text, double content, double times,
             Read read) {
  double memory = 0.0, seconds = 0.0, scan = 0.0;
  for (auto _ : state) {
    if (text) scan += times * benchmarks::scan_seconds(files(matrix));
    const benchmarks::PeakMemory peak;
    const auto start = std::chrono::steady_clock::now();
    const auto data = read();
    seconds += benchmarks::seconds_since(start);
    memory = std::max(memory, peak.rise() / content);
    benchmark::DoNotOptimize(data);
  }
  if (text) state.counters["of_scan"] = seconds / scan;
  state.counters["peak_of_content"] = memory;
  state.counters["MB_per_s"] = 1e-6 * times * files.size(matrix) * static_cast<double>(state.iterations()) / seconds;
}

double content_of_two(bool both_triangles) { return 2.0 * 12.0 * static_cast<double>(count_entries(both_triangles)); }

void calculix(benchmark::State& state) {
  const Files files;
  {
    auto out = fmt::output_file(files("job.sti").string());
    each_entry(false, [&](int i, int j, double value) { out.print("{} {} {:20.13e}\n", j + 1, i + 1, value); });
    auto labels = fmt::output_file(files("job.dof").string());
    for (int i = 0; i < dofs; ++i) labels.print("{}.{}\n", i / 3 + 1, i % 3 + 1);
  }
  std::filesystem::create_hard_link(files("job.sti"), files("job.mas"));
  measure(state, files, "job.sti", true, content_of_two(false), 2.0,
          [&] { return fem::read_calculix_matrices(files("job").string()); });
}

void abaqus(benchmark::State& state) {
  const Files files;
  {
    auto out = fmt::output_file(files("k.mtx").string());
    each_entry(false, [&](int i, int j, double value) {
      out.print("{},{}, {},{}, {:22.15e}\n", i / 3 + 1, i % 3 + 1, j / 3 + 1, j % 3 + 1, value);
    });
  }
  measure(state, files, "k.mtx", true, content_of_two(false), 2.0,
          [&] { return fem::read_abaqus_matrices(files("k.mtx"), files("k.mtx")); });
}

void market(benchmark::State& state, bool general) {
  const Files files;
  {
    auto out = fmt::output_file(files("k.mtx").string());
    out.print("%%MatrixMarket matrix coordinate real {}\n{} {} {}\n", general ? "general" : "symmetric", dofs, dofs,
              count_entries(general));
    each_entry(general, [&](int i, int j, double value) { out.print("{} {} {:.16g}\n", i + 1, j + 1, value); });
    auto labels = fmt::output_file(files("rows.txt").string());
    for (int i = 0; i < dofs; ++i) labels.print("{} {}\n", i / 3 + 1, i % 3 + 1);
  }
  measure(state, files, "k.mtx", true, content_of_two(general), 2.0,
          [&] { return fem::read_market_matrices(files("k.mtx"), files("k.mtx"), files("rows.txt")); });
}
void market_symmetric(benchmark::State& state) { market(state, false); }
void market_general(benchmark::State& state) { market(state, true); }

/// Columns of one matrix, each as strings of consecutive rows.
template <class Column>
void each_column(Column write) {
  struct String {
    int row = 0;
    std::vector<double> values;
  };
  std::vector<String> strings;
  int current = 0;
  each_entry(true, [&](int i, int j, double value) {
    if (j != current) {
      write(current, strings);
      strings.clear();
      current = j;
    }
    if (strings.empty() || strings.back().row + static_cast<int>(strings.back().values.size()) != i)
      strings.push_back({i, {}});
    strings.back().values.push_back(value);
  });
  write(current, strings);
}

void op4_text(benchmark::State& state) {
  const Files files;
  {
    auto out = fmt::output_file(files("k.op4").string());
    out.print("{:8}{:8}{:8}{:8}{:<8}1P,3E23.16\n", dofs, -dofs, 6, 2, "KXX");
    each_column([&](int j, const auto& strings) {
      std::size_t words = 0;
      for (const auto& s : strings) words += 2 + 2 * s.values.size();
      out.print("{:8}{:8}{:8}\n", j + 1, 0, words);
      for (const auto& s : strings) {
        out.print("{:8}{:8}\n", 1 + 2 * s.values.size(), s.row + 1);
        for (std::size_t k = 0; k < s.values.size(); ++k)
          out.print("{:23.15E}{}", s.values[k], k % 3 == 2 || k + 1 == s.values.size() ? "\n" : "");
      }
    });
    out.print("{:8}{:8}{:8}\n{:23.15E}\n", dofs + 1, 1, 1, 1.0);
  }
  measure(state, files, "k.op4", true, 0.5 * content_of_two(true), 1.0, [&] { return fem::read_op4(files("k.op4")); });
}

void op4_binary(benchmark::State& state) {
  const Files files;
  {
    std::ofstream out(files("k.op4"), std::ios::binary);
    const auto put = [](std::string& record, auto value) {
      record.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    const auto write = [&](const std::string& record) {
      const auto length = static_cast<std::int32_t>(record.size());
      for (const char* part : {"length", "record", "length"})
        part[0] == 'l' ? out.write(reinterpret_cast<const char*>(&length), 4)
                       : out.write(record.data(), static_cast<std::streamsize>(record.size()));
    };
    std::string record;
    for (const int word : {dofs, -dofs, 6, 2}) put(record, word);
    write(record + "KXX     ");
    each_column([&](int j, const auto& strings) {
      std::string data;
      for (const auto& s : strings) {
        put(data, static_cast<std::int32_t>(1 + 2 * s.values.size()));
        put(data, static_cast<std::int32_t>(s.row + 1));
        for (const double value : s.values) put(data, value);
      }
      std::string whole;
      for (const auto word : {j + 1, 0, static_cast<int>(data.size() / 4)}) put(whole, word);
      write(whole + data);
    });
    record.clear();
    for (const int word : {dofs + 1, 1, 2}) put(record, word);
    put(record, 1.0);
    write(record);
  }
  measure(state, files, "k.op4", false, 0.5 * content_of_two(true), 1.0, [&] { return fem::read_op4(files("k.op4")); });
}

/// A column of DMIG is a card whose continuations hold an entry each. Both matrices stand in one file.
void dmig(benchmark::State& state) {
  const Files files;
  {
    auto out = fmt::output_file(files("k.pch").string());
    for (int i = 0; i < nodes; ++i) out.print("GRID    {:8}{:8}{:8.1f}{:8.1f}{:8.1f}\n", i + 1, "", 1.0 * i, 0.0, 0.0);
    for (const char* name : {"KAAX", "MAAX"}) {
      out.print("DMIG    {:8}{:8}{:8}{:8}{:8}\n", name, 0, 6, 2, 0);
      int current = -1;
      each_entry(false, [&](int i, int j, double value) {
        if (j != current) out.print("DMIG*   {:16}{:16}{:16}{:16}\n", name, j / 3 + 1, j % 3 + 1, "");
        current = j;
        out.print("*       {:16}{:16}{:16.9E}\n", i / 3 + 1, i % 3 + 1, value);
      });
    }
  }
  measure(state, files, "k.pch", true, content_of_two(false), 1.0,
          [&] { return fem::read_nastran_dmig(files("k.pch").string()); });
}

}  // namespace

BENCHMARK(calculix)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(abaqus)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(market_symmetric)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(market_general)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(op4_text)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(op4_binary)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK(dmig)->Unit(benchmark::kSecond)->Iterations(2);
BENCHMARK_MAIN();
