#include "titop/minimal.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "titop/balance.hpp"
#include "titop/poles_zeros.hpp"
#include "titop/rank_qr.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// TᵀAT, TᵀB with the states that B reaches first
struct Staircase {
  MatrixXd T;
  Index reached = 0;
  double least_kept = 0.0, largest_dropped = 0.0;
};

// B is compressed to its rank r: the first r states are reached; what couples these to the rest is the next B
Staircase staircase(MatrixXd A, const MatrixXd& B, double tolerance) {
  const Index n = A.rows();
  Staircase s{MatrixXd::Identity(n, n), 0, 0.0, 0.0};
  MatrixXd next = B;
  while (s.reached < n) {
    const RankQr qr(next, tolerance);
    s.largest_dropped = std::max(s.largest_dropped, qr.largest_dropped);
    if (qr.rank == 0) break;
    s.least_kept = s.least_kept > 0.0 ? std::min(s.least_kept, qr.least_kept) : qr.least_kept;
    const Index rest = n - s.reached;
    A.bottomRows(rest) = (qr.Q.transpose() * A.bottomRows(rest)).eval();
    A.rightCols(rest) = (A.rightCols(rest) * qr.Q).eval();
    s.T.rightCols(rest) = (s.T.rightCols(rest) * qr.Q).eval();
    next = A.block(s.reached + qr.rank, s.reached, rest - qr.rank, qr.rank);
    s.reached += qr.rank;
  }
  return s;
}

// the states that `start` reaches along non-zero entries A(to, from)
std::vector<char> reached_from(const MatrixXd& A, const MatrixXd& start) {
  std::vector<char> reached(static_cast<std::size_t>(A.rows()), 0);
  std::vector<Index> front;
  const auto reach = [&](Index i) {
    if (std::exchange(reached[static_cast<std::size_t>(i)], 1) == 0) front.push_back(i);
  };
  for (Index i = 0; i < A.rows(); ++i)
    if (!start.row(i).isZero(0.0)) reach(i);
  while (!front.empty()) {
    const Index from = front.back();
    front.pop_back();
    for (Index to = 0; to < A.rows(); ++to)
      if (A(to, from) != 0.0) reach(to);
  }
  return reached;
}

Eigen::VectorXcd joined(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  Eigen::VectorXcd all(a.size() + b.size());
  all << a, b;
  return all;
}

Eigen::VectorXcd poles_of(const MatrixXd& A) {
  return poles({A, MatrixXd(A.rows(), 0), MatrixXd(0, A.rows()), MatrixXd(0, 0), {}, {}});
}

void note(Minimal& result, const Staircase& s) {
  if (s.least_kept > 0.0)
    result.least_kept = result.least_kept > 0.0 ? std::min(result.least_kept, s.least_kept) : s.least_kept;
  result.largest_dropped = std::max(result.largest_dropped, s.largest_dropped);
}

}  // namespace

Minimal minimal(const StateSpace& ss, double tolerance) {
  check(ss);
  Minimal result;
  // what exact zeros cut off goes without rounding: the modes of a modal system that a channel does not touch
  const std::vector<char> driven = reached_from(ss.A, ss.B), watched = reached_from(ss.A.transpose(), ss.C.transpose());
  std::vector<int> keep, still, unwatched;
  for (std::size_t i = 0; i < driven.size(); ++i)
    (!driven[i] ? still : !watched[i] ? unwatched : keep).push_back(static_cast<int>(i));
  const StateSpace joint{ss.A(keep, keep), ss.B(keep, Eigen::all), ss.C(Eigen::all, keep), ss.D, ss.inputs, ss.outputs};

  const Normalised scaled = normalise(joint);
  const Staircase reached = staircase(scaled.A, scaled.B, tolerance);
  note(result, reached);
  MatrixXd T = reached.T.leftCols(reached.reached);  // x̂ = T z on what is kept
  const MatrixXd lost = reached.T.rightCols(scaled.A.rows() - reached.reached);
  result.uncontrollable =
      joined(poles_of(ss.A(still, still)), scaled.rate * poles_of(lost.transpose() * scaled.A * lost));

  const MatrixXd A = T.transpose() * scaled.A * T;
  const Staircase seen = staircase(A.transpose(), (scaled.C * T).transpose(), tolerance);
  note(result, seen);
  const MatrixXd unseen = seen.T.rightCols(A.rows() - seen.reached);
  result.unobservable =
      joined(poles_of(ss.A(unwatched, unwatched)), scaled.rate * poles_of(unseen.transpose() * A * unseen));
  T = (T * seen.T.leftCols(seen.reached)).eval();

  // x = S x̂ with powers of two, TᵀT = 1
  const Eigen::VectorXd& S = scaled.scale;
  result.ss = {scaled.rate * (T.transpose() * scaled.A * T),
               T.transpose() * S.cwiseInverse().asDiagonal() * joint.B,
               joint.C * S.asDiagonal() * T,
               ss.D,
               ss.inputs,
               ss.outputs};
  return result;
}

}  // namespace tenon::titop
