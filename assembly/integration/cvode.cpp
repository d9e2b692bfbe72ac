#include "assembly/integration/cvode.hpp"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cmath>
#include <optional>

#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

template <auto Release>
struct Deleter {
  template <class T>
  void operator()(T* t) const {
    Release(t);
  }
};
struct FreeMemory {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
using Context = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeContext>;
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Deleter<&N_VDestroy>>;
using Linear = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Deleter<&SUNLinSolFree>>;
using Nonlinear = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Deleter<&SUNNonlinSolFree>>;
using Memory = std::unique_ptr<void, FreeMemory>;

struct Problem {
  const Multibody& system;
  Dynamics& dynamics;
  MotionState state;
  VectorXd v_dot;
  Sweeps matrix;  ///< of the preconditioner
  VectorXd bias{}, force{}, x{}, zero{};
  std::string fault{};

  Eigen::Map<VectorXd> map(N_Vector y) const { return {N_VGetArrayPointer(y), system.nq + system.nv}; }

  void unpack(N_Vector y, MotionState& to) const {
    const auto all = map(y);
    to.q = all.head(system.nq);
    to.v = all.tail(system.nv);
    for (std::size_t k = 0; k < system.bodies.size(); ++k)
      if (const HingedBody& b = system.bodies[k]; hinge_coordinates(b.kind) > b.dofs())
        to.q.segment<4>(last_four(k)).normalize();
  }
  Index last_four(std::size_t k) const {
    return system.q_offset[k] + system.bodies[k].modes() + hinge_coordinates(system.bodies[k].kind) - 4;
  }

  // q̇ of v at the attitudes of y: ½ q ⊗ (ω, 0) for quaternions
  void rates(const VectorXd& q, const VectorXd& v, Eigen::Ref<VectorXd> q_dot) const {
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {
      const HingedBody& b = system.bodies[k];
      const bool attitude = hinge_coordinates(b.kind) > b.dofs();
      const Index at = system.q_offset[k], first = system.v_offset[k],
                  plain = b.modes() + b.dofs() - (attitude ? 3 : 0);
      q_dot.segment(at, plain) = v.segment(first, plain);
      if (!attitude) continue;
      const Eigen::Quaterniond turn(0.0, 0.5 * v[first + plain], 0.5 * v[first + plain + 1],
                                    0.5 * v[first + plain + 2]);
      q_dot.segment<4>(at + plain) = (Eigen::Quaterniond(q.data() + at + plain) * turn).coeffs();
    }
  }

  // K r_q: modes and the springs of plain hinge coordinates; those of attitudes are left to the iterations
  void stiffness(const VectorXd& r, VectorXd& f) const {
    f.setZero();
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {
      const HingedBody& b = system.bodies[k];
      const Index n = b.modes(), at = system.q_offset[k], first = system.v_offset[k];
      f.segment(first, n) = b.body->omega.cwiseAbs2().cwiseProduct(r.segment(at, n));
      const Index plain = hinge_coordinates(b.kind) > b.dofs() ? b.dofs() - 3 : b.dofs();
      for (Index j = 0; j < plain; ++j) f[first + n + j] = b.stiffness[j] * r[at + n + j];
    }
  }
};

// C callbacks must not throw: a fault becomes "try a shorter step" (1), and its sentence is kept.
template <class Action>
int guarded(void* data, Action&& action) {
  auto& problem = *static_cast<Problem*>(data);
  try {
    action(problem);
    return 0;
  } catch (const Error& fault) {
    problem.fault = fault.what();
    return 1;
  }
}

int right_side(double t, N_Vector y, N_Vector y_dot, void* data) {
  return guarded(data, [&](Problem& p) {
    p.unpack(y, p.state);
    accelerations(p.dynamics, t, p.state, p.v_dot);
    auto out = p.map(y_dot);
    p.rates(p.state.q, p.state.v, out.head(p.system.nq));
    out.tail(p.system.nv) = p.v_dot;
  });
}

int precondition_setup(double, N_Vector y, N_Vector, int, int* current, double gamma, void* data) {
  return guarded(data, [&](Problem& p) {
    p.unpack(y, p.state);
    set_state(p.system, p.state.q, p.state.v, p.matrix);
    articulate(p.system, p.matrix, {gamma, gamma * gamma});
    inverse_dynamics(p.system, p.matrix, p.zero, p.bias);
    *current = 1;
  });
}

int precondition(double, N_Vector y, N_Vector, N_Vector r, N_Vector z, double gamma, double, int, void* data) {
  return guarded(data, [&](Problem& p) {
    const auto in = p.map(r);
    p.x = in.tail(p.system.nv);
    p.unpack(y, p.state);
    inverse_dynamics(p.system, p.matrix, p.x, p.force);  // M r_v
    p.force -= p.bias;
    const VectorXd r_q = in.head(p.system.nq);
    p.stiffness(r_q, p.state.v);
    p.force -= gamma * p.state.v;
    solve(p.system, p.matrix, p.force, p.x);
    auto out = p.map(z);
    out.tail(p.system.nv) = p.x;
    p.rates(p.state.q, gamma * p.x, out.head(p.system.nq));
    out.head(p.system.nq) += r_q;
  });
}

void silent(int, const char*, const char*, char*, void*) {}

void demand(int flag, const char* what, double t, const Problem& p) {
  if (flag >= 0) return;
  throw NumericalError(
      fmt::format("CVODE gives up at t = {:.6g} s in {}{}{}", t, what, p.fault.empty() ? "" : ": ", p.fault), flag,
      "Loosen --tolerance, or use --method generalized-alpha");
}

}  // namespace

void integrate_cvode(const Multibody& system, Dynamics& dynamics, IntegrationState& state,
                     const IntegrationOptions& options, Integration& result,
                     const std::function<bool(double t, const MotionState& state)>& observe) {
  const bool stiff = options.method == Method::bdf;
  if (dynamics.loops())
    throw ModelError(fmt::format("{} takes no closed loops", name(options.method)),
                     "Use --method dormand-prince, or generalized-alpha with --step");
  Problem p{.system = system,
            .dynamics = dynamics,
            .state = state.at.motion,
            .v_dot = VectorXd::Zero(system.nv),
            .matrix = dynamics.sweeps};
  p.bias = p.force = p.x = p.zero = VectorXd::Zero(system.nv);

  SUNContext made = nullptr;
  SUNContext_Create(nullptr, &made);
  const Context context(made);
  const Vector y(N_VNew_Serial(system.nq + system.nv, made)), at(N_VNew_Serial(system.nq + system.nv, made));
  p.map(y.get()) << state.at.motion.q, state.at.motion.v;
  Linear linear;
  Nonlinear nonlinear;
  const Memory memory(CVodeCreate(stiff ? CV_BDF : CV_ADAMS, made));
  void* cvode = memory.get();
  CVodeSetErrHandlerFn(cvode, silent, nullptr);
  demand(CVodeInit(cvode, right_side, state.t, y.get()), "starting", state.t, p);
  CVodeSetUserData(cvode, &p);
  CVodeSStolerances(cvode, options.tolerance.relative, options.tolerance.absolute);
  CVodeSetMaxNumSteps(cvode, -1);
  CVodeSetMinStep(cvode, 1e-14 * std::max(std::abs(options.until), options.until - state.t));
  if (options.step > 0.0) CVodeSetInitStep(cvode, options.step);
  if (stiff) {
    linear.reset(SUNLinSol_SPGMR(y.get(), SUN_PREC_LEFT, 10, made));
    CVodeSetLinearSolver(cvode, linear.get(), nullptr);
    CVodeSetPreconditioner(cvode, precondition_setup, precondition);
  } else {
    nonlinear.reset(SUNNonlinSol_FixedPoint(y.get(), 2, made));
    CVodeSetNonlinearSolver(cvode, nonlinear.get());
  }

  MotionState shown = state.at.motion;
  const auto interpolated = [&](double t) -> const MotionState& {
    demand(CVodeGetDky(cvode, t, 0, at.get()), "its continuous output", t, p);
    p.unpack(at.get(), shown);
    return shown;
  };
  const auto count = [&] {
    long steps = 0, rejected = 0, iterations = 0;
    CVodeGetNumSteps(cvode, &steps);
    CVodeGetNumErrTestFails(cvode, &rejected);
    CVodeGetNumNonlinSolvIters(cvode, &iterations);
    result.steps = steps;
    result.rejected = rejected;
    result.iterations = iterations;
  };
  bool go_on = true;
  if (state.samples == 0) go_on = observe(state.t, state.at.motion), state.samples = 1;
  double t = state.t;
  std::vector<double> before(options.events.size());
  while (go_on && t < options.until && result.steps < options.most_steps) {
    const double from = t;
    for (std::size_t k = 0; k < before.size(); ++k) before[k] = options.events[k].value(from, shown);
    const int flag = CVode(cvode, options.until, y.get(), &t, CV_ONE_STEP);
    count();
    demand(flag, "a step", t, p);
    double end = std::min(t, options.until);
    std::optional<EventHit> stop;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const Event& event = options.events[k];
      const double after = event.value(t, interpolated(t));
      if (before[k] == 0.0 || (before[k] > 0.0) == (after > 0.0)) continue;
      EventHit hit = locate(event, from, t - from, before[k], after,
                            [&](double step) -> const MotionState& { return interpolated(from + step); });
      if (event.stop && (!stop || hit.t < stop->t)) stop = hit;
      result.events.push_back(std::move(hit));
    }
    if (stop) end = std::min(end, stop->t);
    double seen = from;
    if (options.sample > 0.0) {
      for (; go_on; ++state.samples) {
        const double next = state.begin + static_cast<double>(state.samples) * options.sample;
        if (next > end * (1.0 + 1e-15)) break;
        seen = std::min(end, next);
        go_on = observe(seen, interpolated(seen));
      }
    }
    const bool last = stop || t >= options.until;
    if (go_on && (options.sample == 0.0 || last) && seen < end) {
      go_on = observe(end, interpolated(end));
      ++state.samples;
    }
    state.at.motion = interpolated(end);
    state.t = end;
    if (stop) {
      result.stopped_by = stop->name;
      break;
    }
    if (!before.empty()) interpolated(t);  // where the next step's events begin
  }
}

}  // namespace tenon::assembly
