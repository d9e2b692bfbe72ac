#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "assembly/recursion/port_motion.hpp"
#include "assembly/recursion/sweep_kernels.hpp"
#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

template <class Block>
void rebind(Block& block, double* at, Index rows, Index columns) {
  std::construct_at(&block, at, rows, columns);
}

// Cuts blocks from the store, each at the start of a cache line; without a store it only measures.
struct Cutter {
  double* store = nullptr;
  std::size_t used = 0;
  std::map<std::pair<const ReducedBody*, int>, double*> shared =
      {};  // what is constant; −1: mass, 2p: shapes at port p

  template <class Block>
  void cut(Block& block, Index rows, Index columns) {
    rebind(block, store ? store + used : nullptr, rows, columns);
    used += static_cast<std::size_t>(padded(static_cast<int>(rows * columns)));
  }
  template <class Block>
  void cut_shared(Block& block, Index rows, Index columns, const ReducedBody* body, int port) {
    const auto found = shared.find({body, port});
    if (found != shared.end()) return rebind(block, found->second, rows, columns);
    cut(block, rows, columns);
    shared[{body, port}] = block.data();
  }
};

bool constant_mass(const HingedBody& b) {
  return b.modes() == 0 || !b.body->shape_integrals || b.deformation == Deformation::dropped;
}

void cut_blocks(const Multibody& system, Sweeps& sweeps, Cutter& cutter) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    BodySweep& s = sweeps.bodies[k];
    const Index n = s.n, r = s.r, height = padded(s.n);
    const std::size_t before = cutter.used;
    cutter.cut(s.H_F, 6, r);
    cutter.cut(s.G_R, 6, r);
    cutter.cut(s.b, n + 6, 1);
    cutter.cut(s.inverse, n, 1);
    cutter.cut(s.z_f, height, 1);
    cutter.cut(s.L21, 8, n);
    cutter.cut(s.L11, height, n);
    s.stored = static_cast<int>(cutter.used - before);
    if (constant_mass(b))
      cutter.cut_shared(s.M, n + 6, n + 6, b.body.get(), -1);
    else
      cutter.cut(s.M, n + 6, n + 6);
    if (s.n_t > 0 && s.fixed_node) {
      const ReducedBody* parent = system.bodies[static_cast<std::size_t>(b.parent)].body.get();
      cutter.cut_shared(s.Pi_t, 6, s.n_t, parent, 2 * b.inner_port);
      cutter.cut_shared(s.Pi_tT, padded(s.n_t), 6, parent, 2 * b.inner_port + 1);
    } else {
      cutter.cut(s.Pi_t, 6, s.n_t);
      cutter.cut(s.Pi_tT, padded(s.n_t), 6);
    }
    if (r > 1) cutter.cut(s.D_R, r, r);
    const bool shaped = b.outer_port >= 0 && !b.body->ports[static_cast<std::size_t>(b.outer_port)].Phi.isZero(0.0);
    cutter.cut(s.Pi_F, 6, shaped ? n : 0);
    if (!b.body->stiffening || b.deformation != Deformation::full || n == 0) continue;
    cutter.cut(s.K_G, n, n);
    cutter.cut(s.port_wrenches, 6 * static_cast<Index>(b.body->ports.size()), 1);
    cutter.cut(s.applied, 6 * static_cast<Index>(b.body->ports.size()), 1);
    sweeps.stiffening = true;
  }
  for (BodySweep& s : sweeps.bodies) {  // what the passes leave alone stands apart
    cutter.cut(s.P_rr, 6, 6);
    cutter.cut(s.P_plus, 6, 6);
  }
}

// Sizes, and nodes t and d as they are without deformation.
void set_constants(const Multibody& system, const HingedBody& b, BodySweep& s) {
  s.parent = b.parent;
  s.n = b.modes();
  s.r = b.dofs();
  s.body = b.body.get();
  s.shifts_mass = !constant_mass(b);
  s.sign = b.reversed ? -1.0 : 1.0;
  s.rotor = s.r == 1 ? b.inertia[0] : 0.0;
  s.inner_axes = b.inner_axes;
  s.outer_axes = b.outer_axes;
  if (b.outer_port >= 0)
    s.own_node = b.body->ports[static_cast<std::size_t>(b.outer_port)].position - b.body->reference;
  if (b.parent < 0) return;
  const HingedBody& parent = system.bodies[static_cast<std::size_t>(b.parent)];
  const reduction::BodyPort& port = parent.body->ports[static_cast<std::size_t>(b.inner_port)];
  s.to_node = port.position - parent.body->reference;
  s.n_t = port.Phi.isZero(0.0) ? 0 : parent.modes();
  s.fixed_node = s.n_t == 0 || parent.deformation == Deformation::dropped;
}

// M_m(k) at rest over (η, x_ref), eq (23), and shapes
void set_blocks(const Multibody& system, const HingedBody& b, BodySweep& s) {
  s.M << MatrixXd::Identity(s.n, s.n), b.body->L, b.body->L.transpose(), b.body->D;
  if (s.n_t > 0) {
    const ReducedBody& parent = *system.bodies[static_cast<std::size_t>(b.parent)].body;
    s.Pi_t = parent.ports[static_cast<std::size_t>(b.inner_port)].Phi;
    s.Pi_tT.topRows(s.n_t) = s.Pi_t.transpose();
  }
  if (s.Pi_F.cols() > 0) {  // Π_F^d = φ*(d, k) Π^d
    s.Pi_F = b.body->ports[static_cast<std::size_t>(b.outer_port)].Phi;
    to_reference(s.own_node, s.Pi_F);
  }
  s.plain = b.kind == HingeKind::revolute && s.fixed_node && s.Pi_F.cols() == 0;
  if (!s.plain) return;
  const Vec3 axis = s.sign * b.outer_axes.col(2);  // θ leaves it where it is
  s.H_F.col(0) << -axis.cross(s.own_node), axis;
}

// A place to gather for each body, from its first child's turn (tip to base) to its own. Returns how many it takes.
int share_places(std::vector<BodySweep>& bodies) {
  std::vector<int> free;
  int count = 0;
  const auto take = [&] {
    if (free.empty()) return count++;
    const int place = free.back();
    free.pop_back();
    return place;
  };
  for (auto s = bodies.rbegin(); s != bodies.rend(); ++s) {
    if (s->leaf) s->gathered = take();
    if (s->parent >= 0) {
      BodySweep& parent = bodies[static_cast<std::size_t>(s->parent)];
      s->opens = parent.leaf;
      if (s->opens) parent.gathered = take();
      parent.leaf = false;
    }
    free.push_back(s->gathered);
  }
  return count;
}

}  // namespace

Sweeps make_sweeps(const Multibody& system) {
  Sweeps sweeps;
  sweeps.bodies.resize(system.bodies.size());
  for (std::size_t k = 0; k < system.bodies.size(); ++k) set_constants(system, system.bodies[k], sweeps.bodies[k]);
  Cutter measure, cutter;
  cut_blocks(system, sweeps, measure);
  sweeps.store.resize(measure.used / pad + 1);   // columns of M are read eight at a time
  constexpr std::size_t second_cache = 1 << 20;  // bytes, with room for others
  sweeps.large = measure.used * sizeof(double) + sweeps.bodies.size() * sizeof(BodySweep) > second_cache;
  cutter.store = sweeps.store.front().x;
  cut_blocks(system, sweeps, cutter);
  for (std::size_t k = 0; k < system.bodies.size(); ++k) set_blocks(system, system.bodies[k], sweeps.bodies[k]);
  sweeps.gathered.resize(static_cast<std::size_t>(share_places(sweeps.bodies)));
  return sweeps;
}

Sweeps::Sweeps(const Sweeps& other)
    : bodies(other.bodies),
      gathered(other.gathered),
      stiffening(other.stiffening),
      large(other.large),
      store(other.store) {
  if (store.empty()) return;
  double* const here = store.front().x;
  const double* const there = other.store.front().x;
  for (BodySweep& s : bodies)
    s.blocks([&](auto& block) {
      if (block.data()) rebind(block, here + (block.data() - there), block.rows(), block.cols());
    });
}

Sweeps& Sweeps::operator=(Sweeps other) noexcept {
  bodies.swap(other.bodies);
  gathered.swap(other.gathered);
  store.swap(other.store);
  std::swap(stiffening, other.stiffening);
  std::swap(large, other.large);
  return *this;
}

}  // namespace tenon::assembly
