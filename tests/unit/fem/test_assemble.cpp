#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <omp.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "fem/elements/beam.hpp"
#include "fem/error.hpp"
#include "fem/structure.hpp"

using namespace tenon;
using namespace tenon::fem;

namespace {

/// A space frame of random beams with rigid and averaging links, masses, supports.
Model random_frame(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Model model;
  model.source = "frame";
  for (int i = 0; i < 12; ++i) {
    model.nodes.emplace_back(uniform(random), uniform(random), uniform(random));
    model.node_ids.push_back(100 + i);
  }
  model.materials.push_back({"steel", 2.1e11, 8.0e10, 0.3, 7800.0});
  model.beam_sections.push_back({"rod", 1e-3, 2e-7, 3e-7, 0.0, 4e-7, 0.0, 0.0, 0.5});
  for (int i = 0; i < 9; ++i)
    model.elements.emplace_back(Beam{.nodes = {i, i + 1},
                                     .section = 0,
                                     .material = 0,
                                     .orientation = Vec3(0.3, 0.5, 0.9),
                                     .offsets = {Vec3(0.01 * i, 0, 0), Vec3::Zero()},
                                     .mass = BeamMass::consistent,
                                     .id = i});
  model.elements.emplace_back(PointMass{11, 4.0, Vec3(1, 2, 3).asDiagonal(), Vec3(0.1, 0, 0), 50});
  model.rigid_links.push_back({3, {11}, all_six, Mat3::Identity(), 1});
  model.average_links.push_back({10, all_six, {{0, 1, 0b111}, {4, 2, 0b111}, {7, 1, 0b111}}, 2});
  model.elements.emplace_back(PointMass{10, 2.0, Mat3::Identity(), Vec3::Zero(), 51});
  return model;
}

Eigen::MatrixXd dense(const SparseMatrix& lower) { return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>(); }

}  // namespace

namespace {

/// A wavy sheet of n×n quads, more than one chunk of elements, with links and masses off their nodes.
Model linked_sheet(int n) {
  Model model;
  model.source = "sheet";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      model.nodes.emplace_back(0.1 * i, 0.11 * j, 0.02 * std::sin(0.7 * i + 0.3 * j));
      model.node_ids.push_back(static_cast<long>(model.node_ids.size()) + 1);
    }
  model.materials.push_back({"steel", 2.1e11, 8.0e10, 0.3, 7800.0});
  model.shell_sections.push_back({.name = "skin", .thickness = 2e-3});
  const auto node = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      model.elements.emplace_back(Quad4{{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, 0, 0, i});
  for (int i = 0; i <= n; i += 3)
    model.elements.emplace_back(PointMass{node(i, n), 0.3, Mat3::Identity(), Vec3(0.0, 0.1, 0.05), i});
  model.rigid_links.push_back({node(0, 0), {node(1, 0), node(2, 0), node(3, 0)}, all_six, Mat3::Identity(), 1});
  model.average_links.push_back(
      {node(n, n), all_six, {{node(0, 5), 1.0, 0b111}, {node(5, 0), 1.0, 0b111}, {node(9, 9), 2.0, 0b111}}, 2});
  return model;
}

bool same_digits(const SparseMatrix& a, const SparseMatrix& b) {
  return a.nonZeros() == b.nonZeros() && std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace

TEST(Assemble, DigitsDoNotDependOnTheNumberOfThreads) {
  const Model model = linked_sheet(35);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Structure one = assemble(model);
  for (const int threads : {2, 3, 5}) {
    omp_set_num_threads(threads);
    const Structure many = assemble(model);
    EXPECT_TRUE(same_digits(one.K, many.K)) << threads;
    EXPECT_TRUE(same_digits(one.M, many.M)) << threads;
  }
  omp_set_num_threads(before);
}

// In the first chunk and in later ones, more of them after it.
TEST(Assemble, TheFirstBadElementIsNamedWhateverTheThreadThatMeetsIt) {
  const int before = omp_get_max_threads();
  for (const long first : {3L, 700L, 1200L}) {
    Model model = linked_sheet(35);
    for (const long id : {first, first + 1, first + 9, 1213L}) {
      auto& quad = std::get<Quad4>(model.elements[static_cast<std::size_t>(id)]);
      quad.id = id;
      std::swap(quad.nodes[1], quad.nodes[2]);  // it crosses itself
    }
    for (const int threads : {1, 2, 5}) {
      omp_set_num_threads(threads);
      EXPECT_THAT([&] { assemble(model); },
                  testing::ThrowsMessage<ModelError>(testing::HasSubstr(fmt::format("quad element {}:", first))))
          << threads;
    }
  }
  omp_set_num_threads(before);
}

TEST(Assemble, EqualsTheDenseSumOverElements) {
  const Model model = random_frame(1);
  const Structure s = assemble(model);
  const Eigen::MatrixXd T = s.dofs.expand(Eigen::MatrixXd::Identity(s.n(), s.n()));
  const auto n_full = static_cast<Eigen::Index>(6 * model.nodes.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n_full, n_full), M = K;
  ElementMatrices e;
  for (const Element& element : model.elements) {
    if (const auto* beam = std::get_if<Beam>(&element)) {
      beam_matrices(*beam, model.beam_sections[0], model.materials[0], model.nodes, e);
      for (int a = 0; a < 12; ++a)
        for (int b = 0; b < 12; ++b) {
          const int i = 6 * beam->nodes[static_cast<std::size_t>(a / 6)] + a % 6,
                    j = 6 * beam->nodes[static_cast<std::size_t>(b / 6)] + b % 6;
          K(i, j) += e.K(a, b);
          M(i, j) += e.M(a, b);
        }
    } else if (const auto* mass = std::get_if<PointMass>(&element)) {
      M.block<6, 6>(6 * mass->node, 6 * mass->node) += rigid_mass(mass->mass, mass->offset, mass->inertia);
    }
  }
  EXPECT_LT((dense(s.K) - T.transpose() * K * T).norm(), 1e-13 * K.norm());
  EXPECT_LT((dense(s.M) - T.transpose() * M * T).norm(), 1e-13 * M.norm());
}

TEST(Assemble, FreeFrameHasSixRigidMotionsWithoutForce) {
  const Structure s = assemble(random_frame(2));
  const Eigen::MatrixXd R = rigid_motions(s, Vec3(0.1, -3.0, 2.0));
  const Eigen::MatrixXd K = dense(s.K);
  EXPECT_LT((K * R).norm(), 1e-12 * K.norm() * R.norm());
}

TEST(Assemble, MassFromMatrixEqualsMassFromGeometry) {
  const Model model = random_frame(3);
  const MassProperties m = mass_properties(assemble(model)), g = geometric_mass_properties(model);
  EXPECT_NEAR(m.mass, g.mass, 1e-12 * g.mass);
  EXPECT_LT((m.centre - g.centre).norm(), 1e-12);
  EXPECT_LT((m.inertia - g.inertia).norm(), 1e-11 * g.inertia.norm());
}

// Six bars of a tetrahedron: spread along them, or at their ends as in Nastran's coupled mass.
TEST(Assemble, MassOfRodsEqualsMassFromGeometry) {
  for (const BeamMass kind : {BeamMass::high_order, BeamMass::consistent, BeamMass::nastran}) {
    Model model;
    model.nodes = {Vec3(0, 0, 0), Vec3(1, 0.2, 0), Vec3(0.3, 1.5, 0), Vec3(0.4, 0.1, 2)};
    model.node_ids = {1, 2, 3, 4};
    model.materials.push_back({"steel", 2.1e11, 2.1e11 / 2.6, 0.3, 7800.0});
    model.beam_sections.push_back({.name = "bar", .A = 1e-4});
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) model.elements.push_back(Rod{.nodes = {a, b}, .mass = kind, .id = 4 * a + b});
    const MassProperties m = mass_properties(assemble(model)), g = geometric_mass_properties(model);
    EXPECT_NEAR(m.mass, g.mass, 1e-14 * g.mass);
    EXPECT_LT((m.centre - g.centre).norm(), 1e-14);
    EXPECT_LT((m.inertia - g.inertia).norm(), 1e-13 * g.inertia.norm());
  }
}

TEST(Assemble, ResultDoesNotDependOnTheNumberingOfElements) {
  Model model = random_frame(4);
  const Structure a = assemble(model);
  std::reverse(model.elements.begin(), model.elements.end());
  const Structure b = assemble(model);
  EXPECT_LT((dense(a.K) - dense(b.K)).norm(), 1e-14 * a.K.norm());
}

TEST(Assemble, DofsWithoutStiffnessAndMassAreNamedNotSilent) {
  Model model;
  model.source = "pair";
  model.nodes = {Vec3::Zero(), Vec3::UnitX()};
  model.node_ids = {1, 2};
  model.elements.emplace_back(Spring{0, 0, 1, 0, 5.0, 1});
  model.elements.emplace_back(PointMass{0, 2.0, Mat3::Zero(), Vec3::Zero(), 2});
  const Structure s = assemble(model);
  EXPECT_EQ(s.n(), 4);  // ux of both, uy and uz of the mass
  EXPECT_EQ(s.dofs.unused.size(), 8U);
  EXPECT_THAT(s.dofs.names, testing::ElementsAre("node 1 ux", "node 1 uy", "node 1 uz", "node 2 ux"));
}

TEST(Assemble, AModelWithoutElementsIsRefused) {
  Model model;
  model.source = "void.msh";
  EXPECT_THAT([&] { (void)assemble(model); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("void.msh: the model has no elements")));
}
