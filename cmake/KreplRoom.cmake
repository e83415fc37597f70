# krepl_room(NAME SOURCES a.cpp ... USES room ... LIBRARIES target ...)
# One object library per room. A room sees the public headers and the private headers of the rooms it USES;
# tests/arrows checks that no file includes more than that.
function(krepl_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target krepl_${name})
  add_library(${target} OBJECT ${ROOM_SOURCES})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  # Contraction to fused multiply-add would make a*b + (-a)*b differ from zero, and with it the topology. The others leave results
  # as they are: nothing here reads the errno of mathematical functions or the traps of floating point, and no function is meant to be replaced by a program's own,
  # for which position-independent code else forgoes inlining (8 % of the time of diagrams, 5 to 15 % of surfaces).
  target_compile_options(${target}
    PUBLIC -ffp-contract=off -fno-math-errno -fno-trapping-math -fno-semantic-interposition
    PRIVATE -Wall -Wextra -Wshadow -Wno-psabi)
  foreach(used ${ROOM_USES})
    target_link_libraries(${target} PUBLIC krepl_${used})
  endforeach()
  target_link_libraries(${target} PUBLIC ${ROOM_LIBRARIES})
endfunction()
