#include "assembly/integration/deformation_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "assembly/integration/deflection.hpp"
#include "assembly/recursion/stiffening.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double overshoot = 2.0;  // of an oscillator under a load that steps, over its static deflection
constexpr double infinite = std::numeric_limits<double>::infinity();

SceneSimulation with_level(SceneSimulation section, const Network& network, Flexibility level, bool only_automatic) {
  for (const ReducedBody& body : network.bodies)
    if (!only_automatic || section.of(body.name) == Flexibility::automatic) section.deformation[body.name] = level;
  return section;
}

// The bodies with their modes, carried along the motion of the rigid ones.
class Probe {
 public:
  Probe(const Network& network, const SceneSimulation& section, const SceneSimulation& asked)
      : simulation_(make_simulation(network, section)),
        loads_(make_loads(network, simulation_, section)),
        sweeps_(make_sweeps(simulation_.bodies.system)),
        rows_(make_closure_rows(simulation_.bodies.system)),
        state_(rest_state(simulation_.bodies.system)),
        v_dot_(VectorXd::Zero(simulation_.bodies.system.nv)),
        T_(v_dot_) {
    for (std::size_t k = 0; k < system().bodies.size(); ++k)
      if (system().bodies[k].modes() > 0 && asked.of(system().bodies[k].name) == Flexibility::automatic) {
        plans.push_back({system().bodies[k].name, Flexibility::full, 0.0, 0.0, {}});
        at_.push_back(k);
      }
  }

  // Static deflections under what `sample` of `rigid` does to the bodies.
  void look(const Multibody& rigid, const Sample& sample) {
    follow(rigid, sample);
    set_state(system(), state_.q, state_.v, sweeps_);
    T_.setZero();
    if (loads_) loads_(sample.t, state_, sweeps_, T_);
    restiffen(system(), state_.q, v_dot_, sweeps_);
    inverse_dynamics(system(), sweeps_, v_dot_, T_);
    if (!system().closures.empty()) {
      closure_rows(system(), sweeps_, state_.q, state_.v, rows_);
      T_ -= rows_.J_t * sample.dynamics.lambda;
    }
    VectorXd bent = state_.q;
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const std::size_t k = at_[i];
      const VectorXd stiffness = system().bodies[k].body->omega.cwiseAbs2();
      bent.segment(system().q_offset[k], stiffness.size()) =
          -T_.segment(system().v_offset[k], stiffness.size()).cwiseQuotient(stiffness);
      plans[i].deflection = std::max(plans[i].deflection, overshoot * deflection(system(), k, bent));
      plans[i].softening = std::max(plans[i].softening, softening(k, stiffness));
    }
  }

  double first_frequency(std::size_t i) const { return system().bodies[at_[i]].body->omega.minCoeff(); }

  std::vector<DeformationPlan> plans;

 private:
  const Multibody& system() const { return simulation_.bodies.system; }

  void follow(const Multibody& rigid, const Sample& sample) {
    for (std::size_t k = 0; k < rigid.bodies.size(); ++k) {
      const HingedBody &to = system().bodies[k], &from = rigid.bodies[k];
      const Index nq = hinge_coordinates(to.kind), nv = to.dofs();
      const Index v_to = system().v_offset[k] + to.modes(), v_from = rigid.v_offset[k] + from.modes();
      state_.q.segment(system().q_offset[k] + to.modes(), nq) =
          sample.state.q.segment(rigid.q_offset[k] + from.modes(), nq);
      state_.v.segment(v_to, nv) = sample.state.v.segment(v_from, nv);
      v_dot_.segment(v_to, nv) = sample.v_dot.segment(v_from, nv);
    }
  }

  // |K_G| beside ω²; without the data for K_G the spin, which weakens the first mode by as much
  double softening(std::size_t k, const VectorXd& stiffness) const {
    const BodySweep& s = sweeps_.bodies[k];
    if (s.K_G.size() > 0) return MatrixXd(s.K_G).diagonal().cwiseAbs().cwiseQuotient(stiffness).maxCoeff();
    return s.V.tail<3>().squaredNorm() / stiffness.minCoeff();
  }

  Simulation simulation_;
  Loads loads_;
  Sweeps sweeps_;
  ClosureRows rows_;
  MotionState state_;
  VectorXd v_dot_, T_;
  std::vector<std::size_t> at_;
};

void decide(double tolerance, double band, double first_frequency, DeformationPlan& plan) {
  const double largest = std::max(plan.deflection, plan.softening);
  const double late = band > 0.0 ? (band / first_frequency) * (band / first_frequency) : infinite;
  const std::string seen = fmt::format("deflects by {:.2g} of its size, loads change its stiffness by {:.2g}",
                                       plan.deflection, plan.softening);
  if (!(largest <= tolerance)) {  // NaN included: modes without stiffness
    plan.why = fmt::format("{}, more than the tolerance {:.2g}", seen, tolerance);
  } else if (largest <= 1e-3 * tolerance && late <= tolerance) {
    plan.level = Flexibility::rigid;
    plan.why = fmt::format("{}, and its modes lie {:.2g} times above the band", seen, first_frequency / band);
  } else {
    plan.level = Flexibility::dropped;
    plan.why = fmt::format("{}, within the tolerance {:.2g}", seen, tolerance);
  }
}

}  // namespace

std::vector<DeformationPlan> plan_deformation(const Network& network, const SceneSimulation& section, double until,
                                              double tolerance, double band, const reduction::Progress& progress) {
  Probe probe(network, with_level(section, network, Flexibility::full, true), section);
  if (probe.plans.empty()) return {};
  const SceneSimulation stiff = with_level(section, network, Flexibility::rigid, false);
  std::string failure;
  try {
    const Simulation rigid = make_simulation(network, stiff);
    const Multibody& system = rigid.bodies.system;
    const Loads loads = make_loads(network, rigid, stiff);
    IntegrationOptions options{.method = Method::bdf, .until = until, .sample = until / 1000.0};
    options.tolerance = {1e-4, 1e-6};
    options.most_steps = 200'000;
    IntegrationState state = begin(system, rigid.start);
    failure = integrate(system, loads, state, options, [&](const Sample& sample) {
                probe.look(system, sample);
                if (progress) progress(sample.t / until, "planning");
                return true;
              }).failure;
  } catch (const Error& error) {  // without their modes the bodies cannot move so, or close so
    failure = error.what();
  }
  for (std::size_t i = 0; i < probe.plans.size(); ++i) {
    DeformationPlan& plan = probe.plans[i];
    if (failure.empty())
      decide(tolerance, band, probe.first_frequency(i), plan);
    else
      plan.why = fmt::format("the motion with rigid bodies tells nothing: {}", failure);
  }
  return probe.plans;
}

SceneSimulation with_levels(SceneSimulation section, const std::vector<DeformationPlan>& plan) {
  for (const DeformationPlan& body : plan) section.deformation[body.body] = body.level;
  return section;
}

}  // namespace tenon::assembly
