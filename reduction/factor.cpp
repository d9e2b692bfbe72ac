#include "reduction/factor.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

#include "fem/error.hpp"
#include "reduction/dense.hpp"

namespace tenon::reduction {

namespace {

// CHOLMOD has every routine twice, for 32-bit and for 64-bit indices.
template <class Int>
struct Cholmod;
template <>
struct Cholmod<int> {
  static constexpr int itype = CHOLMOD_INT;
  static constexpr auto start = cholmod_start;
  static constexpr auto finish = cholmod_finish;
  static constexpr auto analyze = cholmod_analyze;
  static constexpr auto factorize = cholmod_factorize;
  static constexpr auto free_factor = cholmod_free_factor;
};
template <>
struct Cholmod<SuiteSparse_long> {
  static constexpr int itype = CHOLMOD_LONG;
  static constexpr auto start = cholmod_l_start;
  static constexpr auto finish = cholmod_l_finish;
  static constexpr auto analyze = cholmod_l_analyze;
  static constexpr auto factorize = cholmod_l_factorize;
  static constexpr auto free_factor = cholmod_l_free_factor;
};

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A view of an Eigen matrix as CHOLMOD's; 64-bit indices are copied.
template <class Int>
class View {
 public:
  explicit View(const fem::SparseMatrix& A) {
    if constexpr (!std::is_same_v<Int, int>) {
      columns_.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1);
      rows_.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
      sparse_.p = columns_.data();
      sparse_.i = rows_.data();
    } else {
      sparse_.p = const_cast<int*>(A.outerIndexPtr());
      sparse_.i = const_cast<int*>(A.innerIndexPtr());
    }
    sparse_.nrow = sparse_.ncol = static_cast<std::size_t>(A.rows());
    sparse_.nzmax = static_cast<std::size_t>(A.nonZeros());
    sparse_.x = const_cast<double*>(A.valuePtr());
    sparse_.stype = -1;  // lower triangle
    sparse_.itype = Cholmod<Int>::itype;
    sparse_.xtype = CHOLMOD_REAL;
    sparse_.dtype = CHOLMOD_DOUBLE;
    sparse_.sorted = 1;
    sparse_.packed = 1;
  }
  cholmod_sparse* operator()() { return &sparse_; }

 private:
  cholmod_sparse sparse_{};
  std::vector<Int> columns_, rows_;
};

// An analysis together with the workspace it lives in.
template <class Int>
class Analysis {
 public:
  Analysis(const fem::SparseMatrix& A, int ordering) {
    using C = Cholmod<Int>;
    C::start(&common_);
    common_.nmethods = 1;
    common_.method[0].ordering = ordering;
    common_.postorder = 1;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
    common_.print = 0;
    common_.quick_return_if_not_posdef = 1;
    View<Int> view(A);
    factor_ = C::analyze(view(), &common_);
    flops = common_.fl;
    nonzeros = common_.lnz;
    status = common_.status;
  }
  ~Analysis() {
    Cholmod<Int>::free_factor(&factor_, &common_);
    Cholmod<Int>::finish(&common_);
  }
  Analysis(const Analysis&) = delete;
  Analysis& operator=(const Analysis&) = delete;

  // −1 or the column of L whose pivot is not positive
  std::int64_t factorize(const fem::SparseMatrix& A) {
    View<Int> view(A);
    Cholmod<Int>::factorize(view(), factor_, &common_);
    status = common_.status;
    if (status < CHOLMOD_OK)
      throw NumericalError(
          "the sparse factorisation ran out of memory", static_cast<double>(factor_->xsize) * 8.0,
          "The figure is the bytes the factor needs: use a machine with more memory or a coarser mesh");
    return status == CHOLMOD_NOT_POSDEF ? static_cast<std::int64_t>(factor_->minor) : -1;
  }

  Supernodes shape() const {
    const auto integers = [](const void* p) { return static_cast<const Int*>(p); };
    Supernodes s;
    const std::size_t count = factor_->nsuper;
    s.n = static_cast<int>(factor_->n);
    for (std::size_t k = 0; k <= count; ++k) s.first.push_back(static_cast<int>(integers(factor_->super)[k]));
    s.row_start.assign(integers(factor_->pi), integers(factor_->pi) + count + 1);
    s.value_start.assign(integers(factor_->px), integers(factor_->px) + count + 1);
    s.rows.reserve(factor_->ssize);
    for (std::size_t k = 0; k < factor_->ssize; ++k) s.rows.push_back(static_cast<int>(integers(factor_->s)[k]));
    return s;
  }
  std::vector<int> permutation() const {
    const Int* p = static_cast<const Int*>(factor_->Perm);
    return {p, p + factor_->n};
  }
  const double* values() const { return static_cast<const double*>(factor_->x); }

  double flops = 0.0, nonzeros = 0.0;
  int status = CHOLMOD_OK;

 private:
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
};

template <class Int>
std::unique_ptr<Analysis<Int>> cheaper_analysis(const fem::SparseMatrix& A, std::string& ordering) {
  const auto analyse = [&A](int method) { return std::make_unique<Analysis<Int>>(A, method); };
  auto other = std::async(std::launch::async, analyse, CHOLMOD_METIS);
  auto amd = analyse(CHOLMOD_AMD);
  auto metis = other.get();
  const bool take_metis = metis->status == CHOLMOD_OK && (amd->status != CHOLMOD_OK || metis->flops < amd->flops);
  ordering = take_metis ? "METIS" : "AMD";
  return take_metis ? std::move(metis) : std::move(amd);
}

}  // namespace

struct Factor::Implementation {
  std::unique_ptr<Analysis<int>> narrow;
  std::unique_ptr<Analysis<SuiteSparse_long>> wide;
  std::vector<int> permutation, inverse;
  TriangularSolver solver;
  FactorReport report;

  const double* values() const { return narrow ? narrow->values() : wide->values(); }

  void digits(const fem::SparseMatrix& A) {
    const Supernodes& f = solver.shape();
    double least = std::numeric_limits<double>::infinity(), greatest = 0.0, worst = 0.0;
    for (int s = 0; s < f.size(); ++s) {
      const double* block = values() + f.value_start[static_cast<std::size_t>(s)];
      for (int j = 0; j < f.columns(s); ++j) {
        const double pivot = block[static_cast<std::int64_t>(j) * (f.height(s) + 1)];
        const int row = permutation[static_cast<std::size_t>(f.first[static_cast<std::size_t>(s)] + j)];
        const double diagonal = A.valuePtr()[A.outerIndexPtr()[row]];
        least = std::min(least, pivot);
        greatest = std::max(greatest, pivot);
        if (const double lost = diagonal / (pivot * pivot); lost > worst) {
          worst = lost;
          report.weakest_row = row;
        }
      }
    }
    report.reciprocal_condition = (least / greatest) * (least / greatest);
    report.lost_digits = std::log10(worst);
  }
};

Factor::Factor(const fem::SparseMatrix& A) : implementation_(std::make_unique<Implementation>()) {
  const auto start = Clock::now();
  const ThreadLimit limit;
  Implementation& f = *implementation_;
  f.narrow = cheaper_analysis<int>(A, f.report.ordering);
  if (f.narrow->status == CHOLMOD_TOO_LARGE) {
    f.narrow.reset();
    f.wide = cheaper_analysis<SuiteSparse_long>(A, f.report.ordering);
  }
  f.report.long_indices = f.wide != nullptr;
  const int status = f.narrow ? f.narrow->status : f.wide->status;
  if (status != CHOLMOD_OK)
    throw NumericalError("the sparse matrix could not be analysed (CHOLMOD's status is the figure)", status,
                         "A figure of −2 means that memory ran out: use a machine with more memory");
  f.report.flops = f.narrow ? f.narrow->flops : f.wide->flops;
  f.report.nonzeros = f.narrow ? f.narrow->nonzeros : f.wide->nonzeros;
  f.permutation = f.narrow ? f.narrow->permutation() : f.wide->permutation();
  f.solver = TriangularSolver(f.narrow ? f.narrow->shape() : f.wide->shape());
  f.report.analyse_seconds = since(start);
}

Factor::~Factor() = default;
Factor::Factor(Factor&&) noexcept = default;
Factor& Factor::operator=(Factor&&) noexcept = default;

int Factor::try_factorize(const fem::SparseMatrix& A) {
  const auto start = Clock::now();
  const ThreadLimit limit;
  Implementation& f = *implementation_;
  const std::int64_t minor = f.narrow ? f.narrow->factorize(A) : f.wide->factorize(A);
  if (minor >= 0) return f.permutation[static_cast<std::size_t>(minor)];
  f.digits(A);
  f.report.factor_seconds = since(start);
  return -1;
}

void Factor::factorize(const fem::SparseMatrix& A, const std::vector<std::string>& names) {
  const int row = try_factorize(A);
  if (row < 0) return;
  const auto r = static_cast<std::size_t>(row);
  throw NumericalError(
      fmt::format("the matrix is not positive definite: the pivot of {} is not positive, its diagonal entry is",
                  r < names.size() ? names[r] : fmt::format("row {}", row)),
      A.coeff(row, row),
      "Something around this place can move without strain: look for loose parts, mechanisms and "
      "missing supports");
}

int Factor::n() const { return implementation_->solver.shape().n; }
const FactorReport& Factor::report() const { return implementation_->report; }
const std::vector<int>& Factor::permutation() const { return implementation_->permutation; }

void Factor::lower(Panel& X) const { implementation_->solver.lower(implementation_->values(), X); }
void Factor::upper(Panel& X) const { implementation_->solver.upper(implementation_->values(), X); }

namespace {

// Runs `work` on panels of eight columns; rows of B are taken in the order `in`, those of the result put in `out`.
template <class Work>
Eigen::MatrixXd by_panels(const Eigen::Ref<const Eigen::MatrixXd>& B, const int* in, const int* out, Work work) {
  const Eigen::Index n = B.rows();
  Eigen::MatrixXd X(n, B.cols());
  Panel panel(n, 8);
  for (Eigen::Index c = 0; c < B.cols(); c += 8) {
    pack(B, c, in, panel);
    work(panel);
    unpack(panel, c, out, X);
  }
  return X;
}

}  // namespace

Eigen::MatrixXd Factor::solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const {
  const int* p = permutation().data();
  return by_panels(B, p, p, [this](Panel& X) { lower(X), upper(X); });
}

Eigen::MatrixXd Factor::half_solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const {
  return by_panels(B, permutation().data(), nullptr, [this](Panel& X) { lower(X); });
}

Eigen::MatrixXd Factor::half_solve_transposed(const Eigen::Ref<const Eigen::MatrixXd>& Y) const {
  return by_panels(Y, nullptr, permutation().data(), [this](Panel& X) { upper(X); });
}

Factor factorize(const fem::SparseMatrix& A, const std::vector<std::string>& names) {
  Factor factor(A);
  factor.factorize(A, names);
  return factor;
}

}  // namespace tenon::reduction
