#include <cholmod.h>
#include <dlfcn.h>
#include <dmumps_c.h>
#include <fmt/format.h>
#include <link.h>
#include <omp.h>
#include <sundials/sundials_config.h>
#include <unistd.h>
#include <zipconf.h>

#include <Spectra/Util/Version.h>
#include <Eigen/Core>
#include <cstdlib>

#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/cost.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// The loaded shared objects whose name contains `part`.
std::string loaded(const char* part) {
  struct Search {
    std::string part, found;
  } search{part, ""};
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        auto& s = *static_cast<Search*>(data);
        const std::string name = info->dlpi_name;
        if (s.found.empty() && name.find(s.part) != std::string::npos) s.found = name;
        return 0;
      },
      &search);
  return search.found.empty() ? "linked statically" : search.found;
}

/// The kernel family that OpenBLAS picked, when OpenBLAS is what is loaded.
std::string blas_kernel() {
  using Name = char* (*)();
  if (void* symbol = dlsym(RTLD_DEFAULT, "openblas_get_corename")) return reinterpret_cast<Name>(symbol)();
  return "unknown: no OpenBLAS is loaded";
}

Json collect() {
  Json object;
  object["tenon"] = TENON_VERSION;
  object["compiler"] = fmt::format("{} {}", "g++", __VERSION__);
  object["libraries"] = {
      {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Spectra", fmt::format("{}.{}.{}", SPECTRA_MAJOR_VERSION, SPECTRA_MINOR_VERSION, SPECTRA_PATCH_VERSION)},
      {"CHOLMOD", fmt::format("{}.{}.{}", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION)},
      {"MUMPS", MUMPS_VERSION},
      {"SUNDIALS", SUNDIALS_VERSION},
      {"libzip", LIBZIP_VERSION},
      {"fmt", FMT_VERSION}};
  object["blas"] = {{"library", loaded("blas")}, {"kernel", blas_kernel()}};
  const char* forced = std::getenv("OPENBLAS_CORETYPE");
  if (forced) object["blas"]["forced_by_OPENBLAS_CORETYPE"] = forced;
  object["cholmod_library"] = loaded("cholmod");
  object["threads"] = omp_get_max_threads();
  object["memory_bytes"] =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
  object["licence"] = {
      {"source", "Apache-2.0"},
      {"binary",
       "GPL-2.0-or-later terms (with Apache-2.0 source: version 3) apply to this binary as a whole, "
       "since Debian's CHOLMOD holds the Supernodal, MatrixOps and Modify modules, which are GPL. MUMPS "
       "is CeCILL-C. The source of the project stays Apache-2.0."}};
  return object;
}

}  // namespace

int run(const DoctorOptions& options) {
  if (options.cost) return run_cost(options);
  const Json object = collect();
  if (options.json) {
    print(object);
    return done;
  }
  Table table({"<what", "<found"});
  table.row({"tenon", object["tenon"]});
  table.row({"compiler", object["compiler"]});
  for (const auto& [name, version] : object["libraries"].items())
    table.row({name, version.is_string() ? version.get<std::string>() : version.dump()});
  table.row({"BLAS", object["blas"]["library"]});
  table.row({"BLAS kernel", object["blas"]["kernel"]});
  table.row({"CHOLMOD from", object["cholmod_library"]});
  table.row({"threads", object["threads"].dump()});
  table.row({"memory", fmt::format("{:.1f} GiB", object["memory_bytes"].get<double>() / 1073741824.0)});
  print(table);
  if (object["blas"].contains("forced_by_OPENBLAS_CORETYPE"))
    print(wrapped(fmt::format("OPENBLAS_CORETYPE={} forces the BLAS kernel, perhaps a slower one: unset it.",
                              object["blas"]["forced_by_OPENBLAS_CORETYPE"].get<std::string>())));
  print("\n" + wrapped("Licence of the source: " + object["licence"]["source"].get<std::string>() + "."));
  print(wrapped("Licence effect on binaries: " + object["licence"]["binary"].get<std::string>()));
  return done;
}

}  // namespace tenon::cli
