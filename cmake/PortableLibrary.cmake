# For builds for other machines, which have none of this machine's compiled libraries: the library without files
# and threads.
set(supple_root ${CMAKE_CURRENT_LIST_DIR}/..)
file(GLOB_RECURSE supple_portable_sources CONFIGURE_DEPENDS ${supple_root}/src/supple/*.cpp
  ${supple_root}/libs/describe/*.cpp ${supple_root}/libs/inspect/*.cpp ${supple_root}/libs/comparison/*.cpp
  ${supple_root}/libs/manifold/*.cpp
  ${supple_root}/models/src/*.cpp ${supple_root}/simulation/src/*.cpp)

# Adds the folders of the library's headers, and symbolic links to the header folders LIBRARY... only: the other
# system headers belong to this machine.
function(supple_use_portable_library target)
  set(headers ${CMAKE_BINARY_DIR}/headers)
  file(MAKE_DIRECTORY ${headers})
  foreach(library IN ITEMS boost hwy Eigen ${ARGN})
    find_path(${library}_parent ${library} PATHS /usr/include /usr/local/include PATH_SUFFIXES eigen3
      NO_CMAKE_FIND_ROOT_PATH REQUIRED)
    file(CREATE_LINK ${${library}_parent}/${library} ${headers}/${library} SYMBOLIC)
  endforeach()
  target_include_directories(${target} SYSTEM PRIVATE ${headers})
  target_include_directories(${target} PRIVATE ${supple_root}/include ${supple_root}/src/supple
    ${supple_root}/libs/describe/include ${supple_root}/libs/inspect/include
    ${supple_root}/libs/comparison/include ${supple_root}/libs/manifold/include ${supple_root}/libs
    ${supple_root}/models/include ${supple_root}/models/src
    ${supple_root}/simulation/include ${supple_root}/simulation/src)
  target_compile_definitions(${target} PRIVATE SUPPLE_SERIAL
    # Older versions of Boost use a class that libc++ has removed, unless this macro is set.
    BOOST_NO_CXX98_FUNCTION_BASE)
  target_link_libraries(${target} PRIVATE supple_compile_options)
endfunction()
