#include "fem/eigen_instances.hpp"

TENON_EIGEN_INSTANCES(template)
