# What most sources read of libraries: parsed once, in precompiled headers.
set(TENON_COMMON_HEADERS <fem/eigen_instances.hpp> <Eigen/SparseCore> <algorithm> <cmath> <filesystem> <functional> <map>
    <memory> <optional> <span> <string> <variant> <vector> <fmt/format.h>)

# A room is one folder, one namespace, one target: tenon_room(fem SOURCES ... PUBLIC ... PRIVATE ...)
# makes the library tenon_fem with the alias tenon::fem, whose include root is the root of the project. All rooms are
# compiled with the same options, so that they share the precompiled headers of fem.
function(tenon_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(tenon_${name} ${ROOM_SOURCES})
  add_library(tenon::${name} ALIAS tenon_${name})
  set_target_properties(tenon_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(tenon_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tenon>)
  target_compile_features(tenon_${name} PUBLIC cxx_std_20)
  if(name STREQUAL fem)
    target_precompile_headers(tenon_fem PRIVATE ${TENON_COMMON_HEADERS})
  else()
    target_precompile_headers(tenon_${name} REUSE_FROM tenon_fem)
  endif()
  target_link_libraries(tenon_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE} OpenMP::OpenMP_CXX
                        $<BUILD_INTERFACE:tenon_options>)
  install(TARGETS tenon_${name} EXPORT tenon-targets)
endfunction()
