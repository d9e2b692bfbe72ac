#include "reduction/block_lanczos.hpp"

#include <algorithm>
#include <cmath>

#include "reduction/dense.hpp"

namespace tenon::reduction {

namespace {

constexpr double vanishing = 1e-13;  // of the operator's size: a column this small is rounding, not direction

}  // namespace

BlockLanczos::BlockLanczos(Eigen::Index n, const LanczosOptions& options, const Eigen::MatrixXd& locked)
    : options_(options), locked_(locked), state_(options.seed * 0x9e3779b97f4a7c15ull + 1) {
  const Eigen::Index room = n - locked.cols();
  const Eigen::Index b = std::min<Eigen::Index>(options_.block, room);
  if (options_.max_basis == 0) options_.max_basis = 3 * options_.wanted + 10 * options_.block;
  options_.max_basis = static_cast<int>(
      std::min<Eigen::Index>(std::max<Eigen::Index>(options_.max_basis, options_.wanted + 4 * b), room));
  Q_.resize(n, options_.max_basis);
  T_ = Eigen::MatrixXd::Zero(options_.max_basis, options_.max_basis);
  Eigen::MatrixXd start(n, b);
  for (Eigen::Index c = 0; c < b; ++c) start.col(c) = random();
  orthogonalise(start, nullptr);
  scale_ = 0.0;
  next_block(start);
}

// splitmix64, so that every library gives the same numbers
Eigen::VectorXd BlockLanczos::random() {
  Eigen::VectorXd v(Q_.rows());
  for (double& x : v) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    x = static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-52 - 1.0;
  }
  return v;
}

// W ← (1 − QQᵀ)(1 − Q_l Q_lᵀ) W twice, the first time along the columns it couples to; H collects QᵀW
void BlockLanczos::orthogonalise(Eigen::MatrixXd& W, Eigen::MatrixXd* H) const {
  for (int pass = 0; pass < 2; ++pass) {
    if (locked_.cols() > 0) subtract_product(locked_, transposed_product(locked_, W), W);
    if (m_ == 0) continue;
    const Eigen::Index from = pass == 0 && H != nullptr ? coupled_ : 0;
    const Eigen::MatrixXd h = transposed_product(Q_.middleCols(from, m_ - from), W);
    subtract_product(Q_.middleCols(from, m_ - from), h, W);
    if (H == nullptr) continue;
    if (pass == 0) H->setZero(m_, W.cols());
    H->bottomRows(m_ - from) += h;
  }
}

// W = F R; E = [0 R]. A column that vanishes leaves a zero row in R and is replaced by a random direction, so that the
// block keeps its width as long as there is space left.
void BlockLanczos::next_block(Eigen::MatrixXd& W) {
  const Eigen::Index n = W.rows(), b = W.cols();
  const Eigen::Index room = n - locked_.cols() - m_;
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(b, b);
  F_.resize(n, std::min(b, room));
  Eigen::Index width = 0;
  for (Eigen::Index c = 0; c < b; ++c) {
    Eigen::VectorXd w = W.col(c);
    for (int pass = 0; pass < 2 && width > 0; ++pass) {
      const Eigen::VectorXd r = F_.leftCols(width).transpose() * w;
      w -= F_.leftCols(width) * r;
      R.col(c).head(width) += r;
    }
    double norm = w.norm();
    const bool fresh = norm <= vanishing * scale_;
    if (width == F_.cols()) continue;
    if (fresh) {
      for (int attempt = 0; attempt < 3; ++attempt) {
        Eigen::MatrixXd v = random();
        v /= v.norm();
        orthogonalise(v, nullptr);
        for (int pass = 0; pass < 2 && width > 0; ++pass)
          v -= F_.leftCols(width) * (F_.leftCols(width).transpose() * v);
        w = v.col(0);
        norm = w.norm();
        if (norm > 1e-6) break;
      }
    } else {
      R(width, c) = norm;
    }
    F_.col(width++) = w / norm;
  }
  F_.conservativeResize(n, width);
  E_ = Eigen::MatrixXd::Zero(width, m_);
  if (m_ >= b) E_.rightCols(b) = R.topRows(width);
}

void BlockLanczos::restart() {
  const Eigen::Index keep =
      std::min<Eigen::Index>(m_ - F_.cols(), options_.wanted + std::max<Eigen::Index>(F_.cols(), options_.wanted / 2));
  Q_.leftCols(keep) = product(Q_.leftCols(m_), S_.leftCols(keep));
  E_ = (E_ * S_.leftCols(keep)).eval();
  T_.setZero();
  T_.topLeftCorner(keep, keep).diagonal() = ritz_.theta.head(keep);
  m_ = keep;
  coupled_ = 0;  // the next block couples to all of them
}

const RitzValues& BlockLanczos::extend(Eigen::MatrixXd image) {
  const Eigen::Index b = F_.cols();
  if (m_ + b > Q_.cols()) {
    if (m_ + b > options_.max_basis && m_ > 3 * b) restart();
    if (m_ + b > Q_.cols()) Q_.conservativeResize(Eigen::NoChange, m_ + b);
  }
  if (T_.rows() < m_ + b) T_.conservativeResize(m_ + b, m_ + b);
  Q_.middleCols(m_, b) = F_;
  m_ += b;
  ++steps_;
  // three-term: C F lies in the previous block, F itself and the next; after a restart in all that was kept
  const Eigen::Index couple_next = m_ - b;
  const bool null = fresh_ && image.norm() <= vanishing * scale_;  // C maps all that is left to zero
  Eigen::MatrixXd H;
  orthogonalise(image, &H);  // F ← C F − Q (QᵀCF)
  coupled_ = couple_next;
  T_.block(0, m_ - b, m_, b) = H;
  T_.block(m_ - b, 0, b, m_) = H.transpose();
  T_.block(m_ - b, m_ - b, b, b) = 0.5 * (H.bottomRows(b) + H.bottomRows(b).transpose());

  SymmetricEigen e = symmetric_eigen(T_.topLeftCorner(m_, m_));
  ritz_.theta = e.values.reverse();
  S_ = e.vectors.rowwise().reverse();
  scale_ = std::max(scale_, ritz_.theta[0]);
  next_block(image);
  ritz_.residual = (E_ * S_).colwise().norm();  // ‖C Qs − θ Qs‖ = ‖E s‖
  fresh_ = E_.norm() <= vanishing * scale_;
  ritz_.exhausted = F_.cols() == 0 || null;
  return ritz_;
}

Eigen::MatrixXd BlockLanczos::vectors(int count) const {
  return product(Q_.leftCols(m_), S_.leftCols(std::min<Eigen::Index>(count, m_)));
}

}  // namespace tenon::reduction
