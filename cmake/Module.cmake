# One static library per module: the folder is the module, its sources are found by name.

add_library(project_warnings INTERFACE)
target_compile_options(project_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow -Wpedantic
                       -Wnon-virtual-dtor -Woverloaded-virtual -Werror)
if(CMAKE_UNITY_BUILD)  # sources become included files there, and types of their anonymous namespaces look like a header's
  target_compile_options(project_warnings INTERFACE -Wno-subobject-linkage)
endif()

add_library(project_sanitizers INTERFACE)
if(SMOKEMAP_SANITIZE STREQUAL "address")
  target_compile_options(project_sanitizers INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  target_link_options(project_sanitizers INTERFACE -fsanitize=address,undefined)
elseif(SMOKEMAP_SANITIZE STREQUAL "thread")
  # GCC's does not understand the fences in Asio, and says so for every one.
  target_compile_options(project_sanitizers INTERFACE -fsanitize=thread -Wno-tsan)
  target_link_options(project_sanitizers INTERFACE -fsanitize=thread)
endif()

# module(NAME DEPS a b PRIVATE_DEPS c): library smokemap_<floor prefix>_NAME from this folder's *.cpp, headers compiled alone
# by the target all_verify_interface_header_sets.
function(module prefix name)
  cmake_parse_arguments(ARG "" "" "DEPS;PRIVATE_DEPS" ${ARGN})
  set(folder ${CMAKE_SOURCE_DIR}/${prefix}/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${folder}/*.hpp)
  set(target ${prefix}_${name})
  if(prefix STREQUAL "engine")
    set(root ${CMAKE_SOURCE_DIR}/engine)
  else()
    set(root ${CMAKE_SOURCE_DIR})
  endif()
  if(sources)
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC ${root})
    target_link_libraries(${target} PUBLIC ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS} project_warnings)
    target_link_libraries(${target} PUBLIC project_sanitizers)
    target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${root})
    target_link_libraries(${target} INTERFACE ${ARG_DEPS} project_sanitizers)
    target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  endif()
endfunction()
