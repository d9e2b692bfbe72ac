#pragma once

#include <Eigen/Core>
#include <utility>

namespace tenon::reduction {

/// The rows of A as an array of arrays: how every file of this project writes a matrix. Json is a type of
/// nlohmann::basic_json, which this header leaves to its callers.
template <typename Json>
Json matrix_rows(const Eigen::Ref<const Eigen::MatrixXd>& A) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < A.cols(); ++j) row.push_back(A(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace tenon::reduction
