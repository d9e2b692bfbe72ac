#include "titop/poles_zeros.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <vector>

#include "fem/error.hpp"
#include "titop/balance.hpp"
#include "titop/rank_qr.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Complex = std::complex<double>;

namespace {

// by |s|, then real part, then imaginary part
VectorXcd sorted(std::vector<Complex> s) {
  const auto key = [](const Complex& z) { return std::tuple(std::abs(z), z.real(), z.imag()); };
  std::sort(s.begin(), s.end(), [&](const Complex& a, const Complex& b) { return key(a) < key(b); });
  return Eigen::Map<VectorXcd>(s.data(), static_cast<Index>(s.size()));
}

// the strongly connected components of the graph of A (Tarjan, SIAM J. Comput. 1 (1972) 146–160)
std::vector<std::vector<int>> components(const MatrixXd& A) {
  const int n = static_cast<int>(A.rows());
  std::vector<std::vector<int>> found;
  std::vector<int> number(static_cast<std::size_t>(n), -1), low(number), stack;
  std::vector<char> on_stack(static_cast<std::size_t>(n), 0);
  int next = 0;
  const std::function<void(int)> visit = [&](int v) {
    const auto at = static_cast<std::size_t>(v);
    number[at] = low[at] = next++;
    stack.push_back(v);
    on_stack[at] = 1;
    for (int w = 0; w < n; ++w) {
      const auto to = static_cast<std::size_t>(w);
      if (A(w, v) == 0.0 || w == v) continue;
      if (number[to] < 0) {
        visit(w);
        low[at] = std::min(low[at], low[to]);
      } else if (on_stack[to]) {
        low[at] = std::min(low[at], number[to]);
      }
    }
    if (low[at] != number[at]) return;
    found.emplace_back();
    for (int w = -1; w != v;) {
      w = stack.back();
      stack.pop_back();
      on_stack[static_cast<std::size_t>(w)] = 0;
      found.back().push_back(w);
    }
  };
  for (int v = 0; v < n; ++v)
    if (number[static_cast<std::size_t>(v)] < 0) visit(v);
  return found;
}

[[noreturn]] void not_converged(Index n) {
  throw NumericalError("the eigenvalues of a system do not converge; its order is", static_cast<double>(n),
                       "Look for entries that are not finite");
}

std::vector<Complex> eigenvalues(const MatrixXd& A) {
  std::vector<Complex> all;
  for (const std::vector<int>& block : components(A)) {
    if (block.size() == 1) {
      all.emplace_back(A(block[0], block[0]), 0.0);
      continue;
    }
    const StateSpace alone{
        A(block, block), MatrixXd(block.size(), 0), MatrixXd(0, block.size()), MatrixXd(0, 0), {}, {}};
    const Eigen::EigenSolver<MatrixXd> solver(balance(alone).ss.A, false);
    if (solver.info() != Eigen::Success) not_converged(A.rows());
    for (const Complex& s : solver.eigenvalues()) all.push_back(s);
  }
  return all;
}

struct Pencil {
  MatrixXd A, B, C, D;
};

// takes out the infinite zeros at the outputs until D has full row rank: outputs without u, C̃x = 0, hold some states at
// zero, and the derivatives of these are outputs of what remains
void reduce(Pencil& s, double tolerance) {
  while (s.D.rows() > 0) {
    const RankQr rows(s.D, tolerance);  // QᵀD = [D̄; 0]
    const Index p = s.D.rows(), sigma = rows.rank;
    if (sigma == p) return;
    s.C = (rows.Q.transpose() * s.C).eval();
    s.D = (rows.Q.transpose() * s.D).topRows(sigma).eval();
    const RankQr held(s.C.bottomRows(p - sigma).transpose(), tolerance);  // C̃Q = [S 0]
    const Index rho = held.rank, free = s.A.rows() - rho;
    const MatrixXd A = held.Q.transpose() * s.A * held.Q, B = held.Q.transpose() * s.B;
    const MatrixXd C = s.C.topRows(sigma) * held.Q;
    MatrixXd C_next(sigma + rho, free), D_next(sigma + rho, B.cols());
    C_next << C.rightCols(free), A.topRightCorner(rho, free);
    D_next << s.D, B.topRows(rho);
    s = {A.bottomRightCorner(free, free), B.bottomRows(free), C_next, D_next};
    if (rho == 0) return;
  }
}

}  // namespace

VectorXcd poles(const StateSpace& ss) {
  check(ss);
  return sorted(eigenvalues(ss.A));
}

VectorXcd zeros(const StateSpace& ss, double tolerance) {
  const Normalised given = normalise(ss);
  Pencil s{given.A, given.B, given.C, given.D};
  reduce(s, tolerance);
  s = {s.A.transpose(), s.C.transpose(), s.B.transpose(), s.D.transpose()};
  reduce(s, tolerance);
  const Index n = s.A.rows(), m = s.D.cols();
  if (n == 0) return VectorXcd(0);
  // [C D] N = 0: the pencil [A − s, B] N = A₁ − s E₁ has the zeros alone
  MatrixXd rows(n + m, s.D.rows()), AB(n, n + m);
  rows << s.C.transpose(), s.D.transpose();
  AB << s.A, s.B;
  const MatrixXd N = RankQr(rows, 0.0).Q.rightCols(n);
  const MatrixXd A1 = AB * N, E1 = N.topRows(n);
  std::vector<Complex> all;
  if (m == 0) {
    all = eigenvalues(s.A);
  } else {
    const Eigen::GeneralizedEigenSolver<MatrixXd> solver(A1, E1, false);
    if (solver.info() != Eigen::Success) not_converged(n);
    for (Index k = 0; k < n; ++k)
      if (std::abs(solver.betas()[k]) > tolerance * std::abs(solver.alphas()[k]))
        all.push_back(solver.alphas()[k] / solver.betas()[k]);
  }
  for (Complex& z : all) z *= given.rate;
  return sorted(all);
}

}  // namespace tenon::titop
