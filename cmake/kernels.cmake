# Compiles each file of src/kernels for the baseline of the platform and, on x86-64, for AVX2 with FMA and for
# AVX-512. Whoever links cspace_kernels gets the definitions by which src/kernels/dispatch.hpp declares the copies.
file(GLOB kernel_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/*.cpp)
list(FILTER kernel_files EXCLUDE REGEX "dispatch.cpp$")
# Kernels without a copy for AVX-512, which would be no faster than that for AVX2 (docs/decisions/avx512.md). Their headers say CSPACE_NARROW_KERNEL.
set(narrow_kernels collision dynamics_regressor ik_arm_angle ik_intervals ik_locked ik_nearest ik_pose ik_subproblems ik_sweep
                   ik_tracking localization_correlation localization_landmarks localization_particles localization_search
                   math_fronts search spatial_rotations trajectory_jerk)
list(TRANSFORM narrow_kernels PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/)
list(TRANSFORM narrow_kernels APPEND .cpp)
set(wide_files ${kernel_files})
list(REMOVE_ITEM wide_files ${narrow_kernels})

add_library(cspace_kernels STATIC src/kernels/dispatch.cpp)
set_target_properties(cspace_kernels PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                                LINKER_LANGUAGE CXX)
target_link_libraries(cspace_kernels PUBLIC cspace PRIVATE cspace_flags)
target_include_directories(cspace_kernels PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/src)

function(add_kernels isa)
  set(files ${kernel_files})
  if(isa STREQUAL "avx512")
    set(files ${wide_files})
  endif()
  add_library(cspace_kernels_${isa} OBJECT ${files})
  set_target_properties(cspace_kernels_${isa} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  target_compile_options(cspace_kernels_${isa} PRIVATE ${ARGN})
  target_compile_definitions(cspace_kernels_${isa} PRIVATE CSPACE_COMPILING_KERNELS
                                                           CSPACE_ISA=${isa} ${kernel_copies})
  target_link_libraries(cspace_kernels_${isa} PRIVATE cspace cspace_flags)
  target_sources(cspace_kernels PRIVATE $<TARGET_OBJECTS:cspace_kernels_${isa}>)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)  # as in src/bindings
    target_precompile_headers(cspace_kernels_${isa} PRIVATE
      <algorithm> <cmath> <cstring> <limits> <utility> <vector>
      ${CMAKE_CURRENT_SOURCE_DIR}/include/cspace/math/registers.hpp)
  endif()
  set_property(GLOBAL APPEND PROPERTY cspace_kernel_copies ${isa})
endfunction()

set(kernel_copies)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND NOT CMAKE_OSX_ARCHITECTURES MATCHES "arm64")
  list(APPEND kernel_copies CSPACE_HAS_AVX2)
  if(CSPACE_AVX512 AND NOT MSVC)  # without vector extensions a pack is an array, to which AVX-512 adds nothing
    list(APPEND kernel_copies CSPACE_HAS_AVX512)
  endif()
endif()
target_compile_definitions(cspace_kernels PUBLIC ${kernel_copies})

if("CSPACE_HAS_AVX2" IN_LIST kernel_copies AND NOT MSVC)
  add_kernels(baseline -O1)  # for processors without AVX2, older than 2013: it compiles in half the time of -O3
else()
  add_kernels(baseline)
endif()
if("CSPACE_HAS_AVX2" IN_LIST kernel_copies)
  if(MSVC)
    add_kernels(avx2 /arch:AVX2)
  else()
    add_kernels(avx2 -mavx2 -mfma)
  endif()
endif()
if("CSPACE_HAS_AVX512" IN_LIST kernel_copies)
  # GCC 12 finds its own AVX-512 headers uninitialised; the other copies keep these warnings.
  add_kernels(avx512 -mavx512f -mavx512dq -mavx512vl -mfma
              $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

# GCC copies structs 16 bytes at a time. A register of four lanes that was stored in two parts is loaded late; so, in other
# files, is one that two stores of two lanes filled.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag("-mmove-max=256 -mstore-max=256" has_wide_moves)
if(has_wide_moves)
  foreach(kernel kinematics dynamics dynamics_simulation dynamics_floats dynamics_regressor dynamics_spatial)
    set_property(SOURCE ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/${kernel}.cpp
                 APPEND PROPERTY COMPILE_OPTIONS -mmove-max=256 -mstore-max=256)
    # A precompiled header brings options of its own.
    set_property(SOURCE ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/${kernel}.cpp PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endif()

# Verdicts on edges and nearest nodes are the same on every machine: no product and sum are rounded at once.
# So are the draws, the moves and the weights of particles.
if(NOT MSVC)
  set_property(SOURCE ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/collision.cpp ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/search.cpp
                      ${CMAKE_CURRENT_SOURCE_DIR}/src/kernels/localization_particles.cpp
               APPEND PROPERTY COMPILE_OPTIONS -ffp-contract=off)
endif()

# The library: what calls the kernels and what needs no instruction set of its own, compiled once behind plain
# functions. The bindings include these headers and no solver. Only its searches and graphs gain from -O3.
# Trees of samples are the same on every machine: none may round a product and a sum at once where others do not. Nor may
# decisions about points, whose signs rest on every rounding as written.
function(configure_library name)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  target_link_libraries(${name} PUBLIC cspace PRIVATE cspace_flags)
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_definitions(${name} PRIVATE ${kernel_copies})
  if(NOT MSVC)
    # The linker drops sections that nobody calls.
    target_compile_options(${name} PRIVATE -ffp-contract=off -ffunction-sections -fdata-sections ${ARGN})
  endif()
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)  # as in src/bindings
    target_precompile_headers(${name} PRIVATE <algorithm> <array> <atomic> <cmath> <functional> <map> <memory> <mutex>
                                              <optional> <queue> <span> <string> <utility> <vector>
      ${CMAKE_CURRENT_SOURCE_DIR}/include/cspace/kinematics/jacobian.hpp
      ${CMAKE_CURRENT_SOURCE_DIR}/include/cspace/collision/scene.hpp
      ${CMAKE_CURRENT_SOURCE_DIR}/include/cspace/collision/robot.hpp)
  endif()
endfunction()
file(GLOB library_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/library/*.cpp)
set(search_files ${library_files})
list(FILTER search_files INCLUDE REGEX "library/(localization|navigation)_")
list(REMOVE_ITEM library_files ${search_files})
add_library(cspace_searches OBJECT ${search_files})
configure_library(cspace_searches)
add_library(cspace_library STATIC ${library_files} $<TARGET_OBJECTS:cspace_searches>)
configure_library(cspace_library $<$<CONFIG:Release>:-O2>)
target_link_libraries(cspace_library PUBLIC cspace_kernels)
if(NOT MSVC)  # loops over the points of clouds and their cells gain from vectors
  set(point_files ${library_files})
  list(FILTER point_files INCLUDE REGEX "library/collision_(cloud|grid|tree)")
  set_property(SOURCE ${point_files} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  set_property(SOURCE ${point_files} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endif()
if(SKBUILD)  # a wheel is built as a whole: its compiler reads what neighbouring files share once
  set_target_properties(cspace_library PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
endif()

# GCC stops inlining in a file that has grown by two fifths, and a file of several searches soon has. It takes this limit
# from a precompiled header, whatever the file asks for.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(large_files ${search_files})
  list(FILTER large_files INCLUDE REGEX "library/navigation_(grid|polygons)")
  set_property(SOURCE ${large_files} APPEND PROPERTY COMPILE_OPTIONS --param=inline-unit-growth=300)
  set_property(SOURCE ${large_files} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endif()
