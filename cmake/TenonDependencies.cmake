# Everything the project links, all of it Debian packages (the list is cmake/packages.txt).
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(spectra 1.0 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(spdlog REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
include(cmake/FindSparseSolvers.cmake)

# libzip: its CMake package demands the programs of zipcmp, which Debian ships apart.
find_path(ZIP_INCLUDE_DIR zip.h REQUIRED)
find_library(ZIP_LIBRARY zip REQUIRED)
add_library(tenon_dep::zip INTERFACE IMPORTED)
target_include_directories(tenon_dep::zip SYSTEM INTERFACE ${ZIP_INCLUDE_DIR})
target_link_libraries(tenon_dep::zip INTERFACE ${ZIP_LIBRARY})
