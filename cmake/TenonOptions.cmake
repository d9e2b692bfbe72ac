# The compile options every target of the project shares.
add_library(tenon_options INTERFACE)
target_compile_features(tenon_options INTERFACE cxx_std_20)
target_compile_options(tenon_options INTERFACE -Wall -Wextra -Wconversion)
if(TENON_WARNINGS_AS_ERRORS)
  target_compile_options(tenon_options INTERFACE -Werror)
endif()
if(CMAKE_UNITY_BUILD)
  # sources that are included look like headers to this warning, whose local types would matter
  target_compile_options(tenon_options INTERFACE -Wno-subobject-linkage)
endif()
