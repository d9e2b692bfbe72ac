#pragma once

#include <cmath>
#include <random>

#include "assembly/network.hpp"

/// Random trees of physically consistent bodies, reproducible from a seed.
namespace tenon::assembly::testing {

/// The same network without dampers, in bodies and in joints.
Network undamped(Network net);

class RandomNetwork {
 public:
  explicit RandomNetwork(unsigned seed) : engine_(seed) {}

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  int integer(int a, int b) { return std::uniform_int_distribution<int>(a, b)(engine_); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }
  double log_uniform(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  Vec3 vector(double size) { return size * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }
  Mat3 rotation();
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns);
  /// An inertia that some set of point masses has: Σ m (r² − r rᵀ).
  Mat3 inertia(double size);

  /// D a true rigid mass, L with LᵀL ≤ 0.8 D, Phi of size 1/√m, ω over two decades.
  ReducedBody body(const std::string& name, bool free_free = false, int most_modes = 10);

  PortRef port(const Network& network, int body);

  /// A joint between two ports with random direction, kind, axis and drive.
  Joint joint(const std::string& name, PortRef inner, PortRef outer);

  /// `any_port`: bodies may hang by any of their ports, be free-free, and be grounded anywhere.
  Network tree(bool any_port);

  /// A tree with up to two joints more, each of which closes a loop, and now and then a second grounded port. About a
  /// third are trees; a few are closed through bodies without enough modes to give way, so that rows are redundant.
  Network scene();

 private:
  // every revolute joint and a few ports get an input and an acceleration output
  void channels(Network& net);

  std::mt19937 engine_;
};

}  // namespace tenon::assembly::testing
