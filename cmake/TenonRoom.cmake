# A room is one folder, one namespace, one target: tenon_room(fem SOURCES ... PUBLIC ... PRIVATE ...)
# makes the library tenon_fem with the alias tenon::fem, whose include root is the root of the project.
function(tenon_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(tenon_${name} ${ROOM_SOURCES})
  add_library(tenon::${name} ALIAS tenon_${name})
  set_target_properties(tenon_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(tenon_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tenon>)
  target_compile_features(tenon_${name} PUBLIC cxx_std_20)
  target_precompile_headers(tenon_${name} PRIVATE <fem/eigen_instances.hpp> <algorithm> <filesystem>
                            <functional> <map> <string> <vector> <fmt/format.h>)
  target_link_libraries(tenon_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE} $<BUILD_INTERFACE:tenon_options>)
  install(TARGETS tenon_${name} EXPORT tenon-targets)
endfunction()
