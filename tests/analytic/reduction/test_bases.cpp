#include <gtest/gtest.h>

#include "tests/analytic/reduction/planar_beam.hpp"
#include "tests/reference/bases.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

// 64 elements with the consistent mass err by (βh)⁴/1440 in frequency, 2e-5 % at βL = 8; the printed references
// themselves are good to half a unit of their last digit, as closed-form integrals allow, and to 3e-5 % at best.
constexpr int elements = 64;
constexpr double discretisation = 5e-5;  // %

struct Errors {
  double first, second;
};

class UniformBeam : public testing::Test {
 protected:
  static ReducedBody reduced(Basis basis, int modes) {
    BeamData data;
    data.elements = elements;
    fem::Model model = beam(data, {{"P", 0}, {"C", elements}});
    bend_in_one_plane(model);
    return reduce(fem::assemble(model), "P", {.basis = basis, .modes = modes, .keep_shapes = false});
  }

  // of the first two flexible modes against the closed form [%]
  static Errors errors(const ReducedBody& body, const std::string& ends, const Eigen::MatrixXd& space = {}) {
    const BeamData data;
    const reference::EndConditions exact = end_conditions(ends);
    const Eigen::VectorXd omega = with_ends(body, ends, space) / data.bending(data.section.Iz);
    const auto off = [&](int mode) {
      const double root = exact.roots[static_cast<std::size_t>(mode)];
      return 100.0 * (omega[exact.rigid + mode] / (root * root) - 1.0);
    };
    return {off(0), off(1)};
  }

  static Errors worst(const ReducedBody& body) {
    Errors most{0.0, 0.0};
    for (const std::string& ends : all_ends()) {
      const Errors e = errors(body, ends);
      most = {std::max(most.first, e.first), std::max(most.second, e.second)};
    }
    return most;
  }

  static void expect_printed(const Errors& e, const std::array<const char*, 2>& text, const std::string& what) {
    const auto first = reference::printed(text[0]), second = reference::printed(text[1]);
    EXPECT_NEAR(e.first, first.value, first.half_unit + discretisation) << what;
    EXPECT_NEAR(e.second, second.value, second.half_unit + discretisation) << what;
  }
};

}  // namespace

TEST_F(UniformBeam, EachBasisHasItsErrorsForEveryEnd) {
  const ReducedBody craig_bampton = reduced(Basis::craig_bampton, 2), clamped_free = reduced(Basis::clamped_free, 4),
                    clamped_free_static = reduced(Basis::clamped_free_static, 2), rubin = reduced(Basis::rubin, 2);
  const Eigen::MatrixXd free = free_free_static(rubin, 2);
  for (const auto& row : reference::uniform_beam_errors) {
    const std::string ends = row.ends;
    expect_printed(errors(craig_bampton, ends), row.craig_bampton, ends + " craig-bampton");
    expect_printed(errors(clamped_free, ends), row.clamped_free, ends + " clamped-free");
    expect_printed(errors(clamped_free_static, ends), row.clamped_free_static, ends + " clamped-free-static");
    expect_printed(errors(rubin, ends, free), row.free_free_static, ends + " free-free modes and static shapes");
  }
}

// Static responses to wrenches and to the inertia of rigid motions are polynomials of degree 5: both bases without
// modes are the paper's G_pol.
TEST_F(UniformBeam, InertiaReliefAloneIsThePapersQuintic) {
  for (const Basis basis : {Basis::craig_bampton_inertia_relief, Basis::rubin}) {
    const ReducedBody body = reduced(basis, 0);
    ASSERT_EQ(body.n(), 4);
    for (const auto& row : reference::uniform_beam_errors) expect_printed(errors(body, row.ends), row.P5, row.ends);
  }
}

// Rayleigh-Ritz: more shapes never make it worse.
TEST_F(UniformBeam, InertiaReliefWithModesIsNeverWorseThanThePaper) {
  for (const Basis basis : {Basis::craig_bampton_inertia_relief, Basis::rubin}) {
    const ReducedBody body = reduced(basis, 2);
    ASSERT_EQ(body.n(), 6);
    for (const auto& row : reference::uniform_beam_errors) {
      const Errors e = errors(body, row.ends);
      EXPECT_LT(e.first, reference::printed(row.P5[0]).value + discretisation) << row.ends;
      EXPECT_LT(e.second, reference::printed(row.P5[1]).value + discretisation) << row.ends;
    }
  }
}

TEST_F(UniformBeam, WorstOfAllEnds) {
  for (const auto& row : reference::uniform_beam_worst) {
    const std::string n = std::to_string(row.n) + " shapes, ";
    expect_printed(worst(reduced(Basis::craig_bampton, row.n - 2)), row.craig_bampton, n + "craig-bampton");
    expect_printed(worst(reduced(Basis::clamped_free_static, row.n - 2)), row.clamped_free_static, n + "static");
    expect_printed(worst(reduced(Basis::rubin, row.n - 4)), row.rubin, n + "rubin");
    expect_printed(worst(reduced(Basis::craig_bampton_inertia_relief, row.n - 4)), row.inertia_relief, n + "relief");
  }
  const Errors eight = worst(reduced(Basis::craig_bampton_inertia_relief, 4));
  EXPECT_LT(eight.first, 1e-3);
  EXPECT_LT(eight.second, 1e-3);
}

// The tapered beam with a mass: where polynomials fail and inertia relief does not. Its elements are prisms of the
// section at mid-length; reduced and unreduced frequencies are of the same elements, so their ratio is off by O(h²) of
// itself, below 1 %. The figures that are printed with two digits get one unit of the last.
TEST(TaperedBeam, WorstOfAllEnds) {
  BeamData data;
  data.elements = 60;
  fem::Model model = beam(data, {{"P", 0}, {"C", data.elements}});
  model.beam_sections.clear();
  for (int k = 0; k < data.elements; ++k) {
    const double f = 1.0 - 0.8 * (k + 0.5) / data.elements;
    fem::BeamSection section = data.section;
    section.A *= f;
    section.Iz *= f * f * f;
    model.beam_sections.push_back(section);
    std::get<fem::Beam>(model.elements[static_cast<std::size_t>(k)]).section = k;
  }
  model.elements.emplace_back(fem::PointMass{.node = 42, .mass = 0.3 * data.mass_total(), .id = 999});
  bend_in_one_plane(model);
  const fem::Structure structure = fem::assemble(model);

  const std::vector<std::string> ends = all_ends();
  std::vector<Eigen::VectorXd> exact;  // frequencies of the elements themselves
  for (const std::string& e : ends) {
    std::vector<int> rows;
    for (int row = 0; row < structure.n(); ++row) {
      const auto& dof = structure.dofs.free[static_cast<std::size_t>(row)];
      const std::size_t end = dof.node == 0 ? 0 : 1;
      const bool at_end = dof.node == 0 || dof.node == data.elements;
      if (!at_end || !(e[end] == 'C' || e[end] == (dof.direction == uy ? 'P' : 'S'))) rows.push_back(row);
    }
    Eigen::MatrixXd K = structure.K, M = structure.M;
    K = Eigen::MatrixXd(K.selfadjointView<Eigen::Lower>());
    M = Eigen::MatrixXd(M.selfadjointView<Eigen::Lower>());
    exact.push_back(frequencies_of(K(rows, rows), M(rows, rows)));
  }
  const auto worst = [&](const ReducedBody& body, const Eigen::MatrixXd& space) {
    Eigen::Vector4d most = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const int rigid = end_conditions(ends[k]).rigid;
      const Eigen::VectorXd omega = with_ends(body, ends[k], space);
      for (int mode = 0; mode < 4 && rigid + mode < omega.size(); ++mode)
        most[mode] = std::max(most[mode], 100.0 * (omega[rigid + mode] / exact[k][rigid + mode] - 1.0));
    }
    return most;
  };
  const auto compare = [&](const Eigen::Vector4d& found, const std::array<const char*, 4>& text, const char* what) {
    for (int mode = 0; mode < 4; ++mode) {
      const auto p = reference::printed(text[static_cast<std::size_t>(mode)]);
      EXPECT_NEAR(found[mode], p.value, 2.0 * p.half_unit + 0.01 * p.value) << what << ", mode " << mode + 1;
    }
  };
  const auto reduced = [&](Basis basis, int modes) {
    return reduce(structure, "P", {.basis = basis, .modes = modes, .keep_shapes = false});
  };
  for (const auto& row : reference::tapered_beam_worst) {
    const Eigen::Vector4d plain = worst(reduced(Basis::craig_bampton, row.n - 2), {}),
                          relief = worst(reduced(Basis::craig_bampton_inertia_relief, row.n - 4), {});
    compare(plain, row.craig_bampton, "craig-bampton");
    compare(relief, row.inertia_relief, "inertia relief");
    const ReducedBody rubin = reduced(Basis::rubin, row.n - 2);
    compare(worst(rubin, free_free_static(rubin, row.n - 2)), row.free_free_static, "free-free and static");
    if (row.n > 4) {
      EXPECT_LT(10.0 * relief[0], plain[0]);
      EXPECT_LT(10.0 * relief[1], plain[1]);
    }
  }
}
