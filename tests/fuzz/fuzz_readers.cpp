// Mutates the shipped meshes and scenes and a small deck for some seconds and reads them. A reader may refuse (an Error
// of the project) or read; anything else that escapes, a crash or memory beyond the limit is a fault. The input being
// read always stands in the folder given, so that a crash leaves its cause behind.
//
//   fuzz_readers SECONDS FOLDER [SEED]

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "assembly/scene.hpp"
#include "fem/error.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/matrices/abaqus.hpp"
#include "fem/formats/matrices/calculix.hpp"
#include "fem/formats/matrices/dmig.hpp"
#include "fem/formats/matrices/op4.hpp"
#include "fem/formats/matrices/superelement.hpp"
#include "fem/formats/nastran.hpp"
#include "fem/formats/read_mesh.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"

namespace {

using namespace tenon;
namespace fs = std::filesystem;
using Random = std::mt19937_64;

struct Seed {
  fs::path name;
  std::string bytes;
};

const char* const deck = R"(SOL 103
CEND
SPC = 1
BEGIN BULK
PARAM,COUPMASS,1
CORD2R  7               0.      0.      0.      0.      0.      1.
        1.      0.      1.
GRID,1,,0.,0.,0.
GRID    2       7       1.      0.      0.
GRID*   3                               1.              1.
*       0.
GRID,4,,0.,1.,0.
MAT1,1,7.+10,,.33,2700.
PBAR,1,1,1.-4,1.-8,1.-8,2.-8
CBAR,1,1,1,2,0.,0.,1.
PSHELL,2,1,.01,1,,1
CQUAD4,2,2,1,2,3,4
CONM2,3,3,,1.5
RBE2,4,1,123456,4
SPC1,1,123456,1
ENDDATA
)";

// a superelement's description; its matrices lie beside it
const char* const description = R"(SECONCT        7       0              NO
               4    1004     101    2101
CORD2R,5,,0.,0.,0.,0.,0.,1.
,1.,1.,0.
GRID,1004,,1.,2.,3.,5
SPOINT,2101
EXTRN,4,123456,101,THRU,101,0
)";

const char* const direct_matrices = R"(GRID,2
SPOINT,20
DMIG,KAAX,0,6,2,0
DMIG*   KAAX                           2               1
*                      2               1 4.000000000D+00
DMIG,KAAX,20,0,,20,0,9.
DMIG,MAAX,0,1,1,0
DMIG,MAAX,2,1,,2,1,1.5
ENDDATA
)";

constexpr const char* abaqus_deck = R"(*HEADING
a frame
*NODE, NSET=ALL
1,0.,0.,0.
2,1.,0.,0.
3,1.,1.,0.
4,0.,1.,0.
5,2.,0.,0.
*ELEMENT, TYPE=S4R, ELSET=SKIN
1,1,2,3,4
*ELEMENT, TYPE=B32, ELSET=BAR
2,1,2,5
*ELEMENT, TYPE=SPRING1, ELSET=K
3,5
*NSET, NSET=ROOT, GENERATE
1,4,3
*MATERIAL, NAME=M
*ELASTIC
7.0D10, .3
*DENSITY
2700.
*SHELL SECTION, ELSET=SKIN, MATERIAL=M
.01
*BEAM SECTION, ELSET=BAR, MATERIAL=M, SECTION=I
.05,.1,.06,.06,.01,.01,.005
0.,1.,0.
*SPRING, ELSET=K
3
1000.
*SURFACE, NAME=S, TYPE=NODE
2,
3,
*COUPLING, REF NODE=5, SURFACE=S, CONSTRAINT NAME=C
*KINEMATIC
1,3
*EQUATION
2
4,1,1.,1,1,-1.
*TRANSFORM, NSET=ROOT, TYPE=C
0.,0.,1.,0.,0.,2.
*BOUNDARY
2,1,6
*STEP
*FREQUENCY
10
*END STEP
)";

constexpr const char* grid = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32">
<UnstructuredGrid><Piece NumberOfPoints="2" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="T" format="ascii">1 2</DataArray></PointData>
<CellData><DataArray type="Int32" Name="part" format="binary">BAAAAAcAAAA=</DataArray></CellData>
<Points><DataArray type="Float32" NumberOfComponents="3">0 0 0 1 0 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="appended" offset="0"/>
<DataArray type="Int64" Name="offsets">2</DataArray><DataArray type="UInt8" Name="types">3</DataArray></Cells></Piece>
</UnstructuredGrid><AppendedData encoding="base64">_EAAAAAAAAAAAAAAAAQAAAAAAAAA=</AppendedData></VTKFile>
)";

const std::string old_grid = R"(# vtk DataFile Version 4.2
line
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 2 double
0 0 0 1 0 0
CELLS 1 3
2 0 1
CELL_TYPES 1
3
CELL_DATA 1
SCALARS part int 1
LOOKUP_TABLE default
7
POINT_DATA 2
FIELD FieldData 1
T 1 2 double
1 2
)";

const std::string binary_grid =
    "# vtk DataFile Version 5.1\nline\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 char\n" +
    std::string("\0\0\0\1\0\0\nCELLS 2 2\nOFFSETS char\n\0\2\nCONNECTIVITY char\n\0\1\n", 54) +
    std::string("CELL_TYPES 1\n\0\0\0\3\nPOINT_DATA 2\nVECTORS u char\nabcdef\n", 53);

/// Files of matrices, of every kind of OP4.
void add_matrices(std::vector<Seed>& all) {
  using fem::testing::Layout;
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(7, 7);
  A(1, 4) = A(4, 1) = 0.5;
  for (const Layout layout : {Layout::dense, Layout::sparse, Layout::big}) {
    const auto number = static_cast<int>(layout);
    all.push_back({fmt::format("binary{}.op4", number), fem::testing::op4_binary("KXX", A, {.layout = layout})});
    all.push_back({fmt::format("ascii{}.op4", number), fem::testing::op4_ascii("KXX", A, {.layout = layout})});
  }
  all.push_back({"foreign.op4", fem::testing::op4_binary("KXX", A, {.type = 1, .foreign = true, .word = 8})});
  all.push_back({"part.asm", description});
  all.push_back({"direct.dmig", direct_matrices});
  all.push_back({"k.mtx", "** K\n5,1, 5,1, 4.0e+00\n2,6, 5,1, -1.5\n2,6,2,6, 3.\n2,1,2,1, 1.0e+36\n"});
  for (const char* ending : {"sti", "mas"})
    all.push_back({std::string("job.") + ending, "1 1  4.0\n1 2 -1.5\n2 2  3.0\n"});
  all.push_back({"job.dof", "7.1\n7.3\n"});
}

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<Seed> seeds() {
  std::vector<Seed> all{{"small.bdf", deck},
                        {"frame.inp", abaqus_deck},
                        {"line.vtu", grid},
                        {"old.vtk", old_grid},
                        {"binary.vtk", binary_grid}};
  add_matrices(all);
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TENON_SOURCE_DIR) / "data"))
    if (const auto extension = entry.path().extension(); extension == ".msh" || extension == ".yaml")
      all.push_back({entry.path().filename(), bytes_of(entry.path())});
  return all;
}

std::size_t below(Random& random, std::size_t n) { return n == 0 ? 0 : random() % n; }

/// One of: a flipped bit, a foreign byte, a cut end, a piece removed, doubled or moved, a number made extreme.
void mutate(std::string& bytes, const std::vector<Seed>& all, Random& random) {
  static const std::string numbers[] = {"-1",   "0",          "999999999999", "1e400", "nan",
                                        "-0.0", "4294967295", "2147483648",   ""};
  const std::size_t at = below(random, bytes.size()), length = std::min(below(random, 64), bytes.size() - at);
  switch (below(random, 8)) {
    case 0:
      if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8)));
      break;
    case 1:
      bytes.insert(at, 1, static_cast<char>(below(random, 256)));
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 5:
      bytes.insert(below(random, bytes.size()), bytes.substr(at, length));
      break;
    case 6: {
      const std::string& other = all[below(random, all.size())].bytes;
      bytes.insert(at, other.substr(below(random, other.size()), 64));
      break;
    }
    default: {
      const std::size_t begin = bytes.find_first_of("0123456789", at);
      if (begin == std::string::npos) break;
      const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", begin), bytes.size());
      bytes.replace(begin, end - begin, numbers[below(random, std::size(numbers))]);
    }
  }
}

void read(const fs::path& file) {
  const fs::path extension = file.extension();
  if (extension == ".op4")
    fem::read_op4(file);
  else if (extension == ".asm")
    fem::read_nastran_superelement(file.string());
  else if (extension == ".dmig")
    fem::read_nastran_dmig(file.string());
  else if (extension == ".mtx")
    fem::read_abaqus_matrices(file, file);
  else if (extension == ".sti" || extension == ".mas" || extension == ".dof")
    fem::read_calculix_matrices(file.string());
  else if (file.extension() == ".yaml")
    assembly::read_scene(file);
  else if (extension == ".inp")
    fem::read_deck(file, true);
  else if (file.extension() == ".bdf" && fem::nastran_gives_sections(file))
    fem::read_nastran(file);
  else
    fem::read_mesh(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: fuzz_readers SECONDS FOLDER [SEED]\n");
    return 2;
  }
  const double seconds = std::stod(argv[1]);
  const std::uint64_t seed = argc > 3 ? std::stoull(argv[3]) : std::random_device{}();
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30};  // a reader that believes a declared count runs into this
  setrlimit(RLIMIT_AS, &memory);
#endif
  const fs::path folder = argv[2];
  fs::create_directories(folder);
  const std::vector<Seed> all = seeds();
  // what the files of a job and of a superelement find beside them, whichever of them is mutated
  const auto restore = [&] {
    for (const Seed& seed : all)
      if (seed.name.stem() == "job") std::ofstream(folder / seed.name, std::ios::binary) << seed.bytes;
  };
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(7, 7);
  std::ofstream(folder / "part.op4", std::ios::binary)
      << fem::testing::op4_binary("KXX", one) << fem::testing::op4_binary("MXX", one);
  Random random(seed);
  long read_count = 0, refused = 0;
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
    const Seed& origin = all[below(random, all.size())];
    std::string bytes = origin.bytes;
    for (std::size_t k = 1 + below(random, 4); k > 0; --k) mutate(bytes, all, random);
    const fs::path file = folder / origin.name;
    restore();
    std::ofstream(file, std::ios::binary) << bytes;
    try {
      read(file);
      ++read_count;
    } catch (const Error&) {
      ++refused;
    } catch (const std::exception& fault) {
      fmt::print(stderr, "{}: {} escaped a reader (seed {})\n", file.string(), fault.what(), seed);
      return 1;
    }
  }
  fs::remove_all(folder);
  fmt::print("{} inputs read, {} refused, nothing else escaped (seed {})\n", read_count, refused, seed);
  return 0;
}
