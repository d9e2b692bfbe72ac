// Modes that another program printed of a clamped part (.f06), as a body by `reduced:`. The runs here are written by
// this file in Nastran's layout: none is by Nastran.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assembly/build.hpp"
#include "fem/formats/f06.hpp"
#include "fem/formats/nastran.hpp"
#include "reduction/reduce.hpp"
#include "tests/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::assembly;
using testing::HasSubstr;

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

std::string header(int page) {
  return fmt::format("1    CLAMPED PART            NOVEMBER  23, 2026  NASTRAN  1/ 1/26   PAGE {:5}\n \n0\n", page);
}

std::string eigenvalue_table(const std::vector<fem::ModalRow>& rows) {
  std::string text =
      header(1) +
      "                      R E A L   E I G E N V A L U E S\n"
      "   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED "
      "        GENERALIZED\n    NO.       ORDER                                        MASS      STIFFNESS\n";
  for (std::size_t j = 0; j < rows.size(); ++j)
    text += fmt::format("{:9}{:10}{:20.6E}{:20.6E}{:20.6E}{:20.6E}{:20.6E}\n", j + 1, j + 1, rows[j].lambda,
                        std::sqrt(rows[j].lambda), std::sqrt(rows[j].lambda) / (2 * M_PI), rows[j].generalized_mass,
                        rows[j].generalized_mass * rows[j].lambda);
  return text;
}

std::string shape_heading(int mode, double lambda) {
  return fmt::format(
      "      EIGENVALUE = {:14.6E}\n          CYCLES = {:14.6E}         R E A L   E I G E N V E C T O R   N O . {:10}\n"
      " \n      POINT ID.   TYPE          T1             T2             T3             R1             R2             "
      "R3\n",
      lambda, std::sqrt(lambda) / (2 * M_PI), mode);
}

std::string shape_row(long id, const Vec6& u, int decimals = 6) {
  std::string text = fmt::format("{:14}      G   ", id);
  for (const double x : u) text += x == 0.0 ? std::string("   0.0         ") : fmt::format("{:15.{}E}", x, decimals);
  return text + "\n";
}

/// A bar without mass, 2 m along x, 3 kg at its end: ω² = 3EI/(mℓ³), tip slope 3/(2ℓ) of its deflection.
const std::string bar_deck = R"(SOL 103
CEND
SPC = 1
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,2.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
PBAR,1,1,1.,4.-6,1.,1.
MAT1,1,2.+9,,.3
CONM2,3,2,,3.
SPC1,1,123456,1
ASET1,123456,2
ENDDATA
)";
const double bar_lambda = 3.0 * 2e9 * 4e-6 / (3.0 * 8.0);

std::string bar_run() {
  return eigenvalue_table({{bar_lambda, 12.0}}) + header(2) + shape_heading(1, bar_lambda) +
         shape_row(1, Vec6::Zero()) + shape_row(2, (Vec6() << 0, 2, 0, 0, 0, 1.5).finished()) + header(3) +
         "                   O U T P U T   F R O M   G R I D   P O I N T   W E I G H T   G E N E R A T O R\n"
         "0                              REFERENCE POINT =        0\n                   M O\n"
         " *  3.000000E+00  0.0  0.0  0.0  0.0  0.0 *\n *  0.0  3.000000E+00  0.0  0.0  0.0  6.000000E+00 *\n"
         " *  0.0  0.0  3.000000E+00  0.0 -6.000000E+00  0.0 *\n *  0.0  0.0  0.0  0.0  0.0  0.0 *\n"
         " *  0.0  0.0 -6.000000E+00  0.0  1.200000E+01  0.0 *\n *  0.0  6.000000E+00  0.0  0.0  0.0  1.200000E+01 "
         "*\n                   S\n * 1.0 0.0 0.0 *\n";
}

/// A bent cantilever with an RBE2 to a body at its end.
std::string frame_deck() {
  std::string text = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\n";
  for (int k = 0; k < 9; ++k)
    text += fmt::format("GRID,{},,{},{},0.2\n", 10 + k, k < 6 ? 0.3 * k : 1.5, k < 6 ? 0.0 : 0.25 * (k - 5));
  text += "GRID,40,,1.5,0.9,0.4\n";
  for (int k = 0; k < 8; ++k) text += fmt::format("CBAR,{},1,{},{},0.1,0.2,1.\n", k + 1, 10 + k, 11 + k);
  return text +
         "PBAR,1,1,2.-3,3.-6,5.-7,4.-7\nMAT1,1,7.+10,,.33,2700.\nRBE2,60,18,123456,40\n"
         "CONM2,70,40,,5.,,,,,+\n+,.1,.01,.2,0.,.02,.15\nSPC1,1,123456,10\nASET1,123456,18\nENDDATA\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class ModalRunDoor : public testing::Test {
 protected:
  ReducedBody body(const std::string& deck, const std::string& run, const std::string& units = "SI") const {
    folder_.write("run.bdf", deck);
    folder_.write("run.f06", run);
    const Scene s =
        read_scene(folder_.write("scene.yaml", fmt::format("units: {}\nbodies:\n  b: {{reduced: run.f06}}\n", units)));
    return build_network(s, plan(s)).bodies.front();
  }
  TemporaryFolder folder_;
};

}  // namespace

// Closed form; ω² is printed to 7 digits, the rest exactly.
TEST_F(ModalRunDoor, BarWithAMassAtItsEnd) {
  const ReducedBody b = body(bar_deck, bar_run());
  ASSERT_EQ(b.n(), 1);
  EXPECT_NEAR(b.omega[0], std::sqrt(bar_lambda), 2.5e-7 * b.omega[0]);
  const double m = 3.0, l = 2.0;
  const Vec6 participation = (Vec6() << 0, 1, 0, 0, 0, l).finished() * std::sqrt(m);
  EXPECT_LT((b.L.row(0).transpose() - participation).norm(), 1e-14);
  EXPECT_LT((b.D - fem::rigid_mass(m, {l, 0, 0}, fem::Mat3::Zero())).norm(), 1e-14);
  ASSERT_EQ(b.ports.size(), 2U);
  EXPECT_EQ(b.ports[0].name, "g1");
  EXPECT_EQ(b.ports[1].name, "g2");
  EXPECT_EQ(b.ports[0].Phi.norm(), 0.0);
  const Vec6 tip = (Vec6() << 0, 1, 0, 0, 0, 1.5 / l).finished() / std::sqrt(m);
  EXPECT_LT((b.ports[1].Phi.col(0) - tip).norm(), 1e-14);
}

// Deck -> own modes -> .f06 -> body is our own reduction to the printed digits: 5e-7 of each number, which ΦᵀMR and
// the step to orthonormal shapes take over at most twice; a figure is weighed by √D, which bounds it.
TEST_F(ModalRunDoor, RoundTripIsOurOwnReductionToTheDigits) {
  folder_.write("own.bdf", frame_deck());
  fem::Model model = fem::read_nastran(folder_.path() / "own.bdf").model;
  model.supports.clear();
  model.ports = {{"g10", 0}, {"g18", 8}};
  const fem::Structure s = fem::assemble(model);
  const ReducedBody own =
      reduction::reduce(s, "g10", {.basis = reduction::Basis::clamped_free, .modes = 6, .progress = {}});
  for (const int decimals : {4, 6}) {
    std::string vectors;
    std::vector<fem::ModalRow> rows;
    for (int j = 0; j < 6; ++j) {
      const double scale = 0.5 + j;  // not normalised to mass
      rows.push_back({own.omega[j] * own.omega[j], scale * scale});
      vectors += header(2 * j + 2) + shape_heading(j + 1, rows.back().lambda);
      for (std::size_t k = 0; k < s.nodes.size(); ++k) {
        if (k == 5) vectors += header(2 * j + 3) + shape_heading(j + 1, rows.back().lambda);  // the next page
        vectors +=
            shape_row(s.node_ids[k], scale * own.node_shapes.col(j).segment<6>(6 * static_cast<long>(k)), decimals);
      }
    }
    const ReducedBody b = body(frame_deck(), eigenvalue_table(rows) + vectors);
    const double digit = 0.5 * std::pow(10.0, -decimals);
    ASSERT_EQ(b.n(), 6);
    EXPECT_LT((b.D - own.D).norm(), 1e-13 * own.D.norm());
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(b.omega[j] / own.omega[j], 1.0, 2.5e-7) << j;
      for (int d = 0; d < 6; ++d)
        EXPECT_NEAR(b.L(j, d), own.L(j, d), 4 * digit * std::sqrt(own.D(d, d))) << j << ' ' << d;
    }
    const fem::Mat6X& tip = own.ports[1].Phi;
    EXPECT_LT((b.ports[1].Phi - tip).cwiseAbs().maxCoeff(), 4 * digit * tip.cwiseAbs().maxCoeff());
    EXPECT_LT(b.certificate.max_orthogonality, 4 * digit);
    EXPECT_GT(b.certificate.max_orthogonality, 1e-3 * digit);
    EXPECT_THAT(b.certificate.left_out.front(), HasSubstr(fmt::format("beyond the {} that", decimals + 1)));
  }
}

// The bar in millimetres, tonnes and seconds, and in inches and pounds with WTMASS, shapes unchanged in number: each
// system gives the bar of the first test. The scale of the shape is that of its translations.
TEST_F(ModalRunDoor, UnitsAreTheScenes) {
  const ReducedBody si = body(bar_deck, bar_run());
  const auto real = [](double x) {
    std::string text = fmt::format("{:.9E}", x);
    return text.erase(text.find('E'), 1);  // 1.5+03, sixteen columns at most
  };
  struct System {
    const char* units;
    double length, mass, force;  // of one unit in SI
    double weight;               // masses that the deck counts, for one of its masses in motion
  };
  const double inch = 0.0254, pound = 0.45359237, lbf = pound * 9.80665;
  for (const System& u :
       {System{"mm-t-s", 1e-3, 1e3, 1.0, 1.0}, System{"inch-lbf", inch, lbf / inch, lbf, lbf / inch / pound},
        System{"{length: cm, mass: g, time: ms}", 1e-2, 1e-3, 10.0, 1.0}}) {
    const double time = std::sqrt(u.mass * u.length / u.force), pressure = u.force / (u.length * u.length);
    std::string deck = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,WTMASS," + real(1.0 / u.weight) + "\n";
    deck += "GRID,1,,0.,0.,0.\nGRID,2,," + real(2.0 / u.length) + ",0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n";
    deck += "PBAR,1,1,1.," + real(4e-6 / std::pow(u.length, 4)) + ",1.,1.\nMAT1,1," + real(2e9 / pressure) + ",,.3\n";
    deck += "CONM2,3,2,," + real(3.0 / u.mass * u.weight) + "\nSPC1,1,123456,1\nASET1,123456,2\nENDDATA\n";
    const double lambda = bar_lambda * time * time;  // tip 2 units of length, slope 3/(2 l) of it; m = 4 of its masses
    std::string run = eigenvalue_table({{lambda, 12.0 / u.mass}}) + header(2) + shape_heading(1, lambda) +
                      shape_row(1, Vec6::Zero()) + shape_row(2, (Vec6() << 0, 2, 0, 0, 0, 1.5 * u.length).finished());
    run += header(3) +
           "                   O U T P U T   F R O M   G R I D   P O I N T   W E I G H T   G E N E R A T O R\n"
           "0                              REFERENCE POINT =        0\n                   M O\n";
    for (int row = 0; row < 6; ++row)
      run += row == 0 ? fmt::format(" *  {:.6E}  0.0  0.0  0.0  0.0  0.0 *\n", 3.0 / u.mass * u.weight)
                      : std::string(" *  0.0  0.0  0.0  0.0  0.0  0.0 *\n");
    const ReducedBody b = body(deck, run, u.units);
    // seven printed digits of λ and of the slope; the deck's ten
    EXPECT_NEAR(b.omega[0] / si.omega[0], 1.0, 3e-7) << u.units;
    EXPECT_LT((b.D - si.D).norm(), 1e-8 * si.D.norm()) << u.units;
    EXPECT_LT((b.L - si.L).norm(), 1e-8 * si.L.norm()) << u.units;
    EXPECT_LT((b.ports[1].Phi - si.ports[1].Phi).norm(), 1e-6 * si.ports[1].Phi.norm()) << u.units;
    EXPECT_NEAR(b.ports[1].position.x(), 2.0, 1e-9) << u.units;
  }
}

// Clamped at two grids: the body that we reduce where an RBE2 ties the one to the other.
TEST_F(ModalRunDoor, SeveralClampedGridsAreOneRigidPiece) {
  folder_.write("own.bdf", replaced(frame_deck(), "RBE2,60", "RBE2,61,10,123456,12\nRBE2,60"));
  fem::Model model = fem::read_nastran(folder_.path() / "own.bdf").model;
  model.supports.clear();
  model.ports = {{"g10", 0}, {"g18", 8}};
  const fem::Structure s = fem::assemble(model);
  const ReducedBody own =
      reduction::reduce(s, "g10", {.basis = reduction::Basis::clamped_free, .modes = 3, .progress = {}});
  std::string vectors;
  std::vector<fem::ModalRow> rows;
  for (int j = 0; j < 3; ++j) {
    rows.push_back({own.omega[j] * own.omega[j], 1.0});
    vectors += header(j + 2) + shape_heading(j + 1, rows.back().lambda);
    for (std::size_t k = 0; k < s.nodes.size(); ++k)
      vectors += shape_row(s.node_ids[k], own.node_shapes.col(j).segment<6>(6 * static_cast<long>(k)));
  }
  const ReducedBody b =
      body(replaced(frame_deck(), "SPC1,1,123456,10", "SPC1,1,123456,12,10"), eigenvalue_table(rows) + vectors);
  ASSERT_EQ(b.ports.size(), 2U);
  EXPECT_EQ(b.ports[0].name, "g10");  // the lowest number, whatever the order of the card
  EXPECT_LT((b.D - own.D).norm(), 1e-13 * own.D.norm());
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(b.omega[j] / own.omega[j], 1.0, 2.5e-7) << j;  // as in the round trip
    for (int d = 0; d < 6; ++d) EXPECT_NEAR(b.L(j, d), own.L(j, d), 2e-6 * std::sqrt(own.D(d, d))) << j << ' ' << d;
  }
  EXPECT_THAT(fmt::format("{}", fmt::join(b.certificate.left_out, "; ")), HasSubstr("2 clamped nodes"));
}

TEST_F(ModalRunDoor, RefusesWhatIsNotOfOneRun) {
  struct Fault {
    const char* from;
    const char* to;
    const char* says;
    bool in_deck;
  };
  const Fault faults[] = {
      {"R E A L   E I G E N V A L", "C O M P L E X   E I G E N V A L", "complex modes", false},
      {"1    CLAMPED", "^^^ USER FATAL MESSAGE 9050\n1    CLAMPED", "fatal message", false},
      {"1.000000E+03", "0.000000E+00", "mode 1 has the eigenvalue 0", false},
      {"1.000000E+03", "1.100000E+03", "contradict each other", false},
      {"N O .          1", "N O .          2", "eigenvector 1 is missing", false},
      {"N O .          1", "N O .", "without its number", false},
      {"   2.000000E+00", "       2.00E+0q", "not a number", false},
      {"   2.000000E+00", "   +-2.00000E+0", "not a number", false},
      {"   2.000000E+00", "", "5 of 6 numbers", false},
      {"   2.000000E+00", "   2.100000E+00", "not orthonormal", false},
      {"0.0            0.0            0.0", "1.0            0.0            0.0", "where the clamp says 0", false},
      {"             2      G", "             7      G", "node 2 has mass", false},
      {"             2      G", "             1      G", "grid 1 of mode 1 is given twice", false},
      {" *  3.000000E+00", " *  3.100000E+00", "counts the mass 3.1, the deck has 3", false},
      {"E I G E N V E C T O R", "F O R C E S", "no eigenvectors", false},
      {"CONM2,3,2,,3.", "CONM2,3,2,,3.2", "not orthonormal", true},
      {"GRID,2,,2.,0.,0.", "CORD2R,9,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nGRID,2,,2.,0.,0.,9",
       "grid 2 has a displacement frame", true},
      {"SPC1,1,123456,1", "SPC1,1,12345,1", "no grid is held", true},
      {"SPC1,1,123456,1", "SPC1,1,123456,1,2", "moves node 2 uy by 2, where the clamp says 0", true},
      {"SPC1,1,123456,1", "SPC1,1,123456,1\nSPC1,1,3,2", "node 2 uz is held beside the clamp", true},
  };
  for (const Fault& f : faults)
    EXPECT_THAT(tests::refusal([&] {
                  body(f.in_deck ? replaced(bar_deck, f.from, f.to) : bar_deck,
                       f.in_deck ? bar_run() : replaced(bar_run(), f.from, f.to));
                }),
                HasSubstr(f.says))
        << f.from << " -> " << f.to;
  folder_.write("alone.f06", bar_run());
  const Scene alone = read_scene(folder_.write("alone.yaml", "units: SI\nbodies: {b: {reduced: alone.f06}}\n"));
  EXPECT_THAT(tests::refusal([&] { build_network(alone, plan(alone)); }), HasSubstr("no deck beside it"));
}

TEST_F(ModalRunDoor, EveryCutOfTheFileIsReadOrRefused) {
  const std::string run = bar_run();
  for (std::size_t n = 0; n < run.size(); n += 7) {
    folder_.write("cut.f06", run.substr(0, n));
    try {
      const fem::ModalRun read = fem::read_f06(folder_.path() / "cut.f06");
      EXPECT_EQ(read.modes.size(), 1U);
    } catch (const InputError& fault) {
      EXPECT_THAT(fault.what(), HasSubstr("cut.f06"));
    }
  }
}
