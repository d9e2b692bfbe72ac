#pragma once

#include "titop/high.hpp"
