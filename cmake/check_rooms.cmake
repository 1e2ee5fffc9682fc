# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
cmake_minimum_required(VERSION 3.16)
# cmake -DLIBRARY=libbeautymap_core.so -DSOURCE_DIR=. -P check_rooms.cmake
# Fails when the core library links a ROS library, or when one of its files includes a header of ROS
# (Debian has them in /usr/include: the compiler finds them), or of a room that it must not know.

# What each room of the core may include, beside itself.
set(base "")
set(config "")
set(matrix base config)
set(ground base config matrix)
set(judgement base config matrix)
set(published base config matrix ground judgement)
set(evidence base config matrix ground judgement)
set(cleaner base config matrix ground judgement published evidence)
set(evaluation base config matrix)
set(rooms base config matrix ground judgement published evidence cleaner evaluation)

set(ros "ros[a-z]*|tf|tf2|tf2_[a-z]+|pcl_ros|pcl_conversions|[a-z_]+_msgs")

if(LIBRARY MATCHES "\\.so$")
  execute_process(COMMAND ldd "${LIBRARY}" OUTPUT_VARIABLE linked RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "ldd ${LIBRARY} failed")
  endif()
  if(linked MATCHES "lib(ros|tf2|cpp_common|xmlrpcpp|beautymap)[a-z_]*\\.so")
    message(FATAL_ERROR "the core library links ${CMAKE_MATCH_0}:\n${linked}")
  endif()
endif()

foreach(room IN LISTS rooms)
  set(allowed ${room} ${${room}})
  file(GLOB files "${SOURCE_DIR}/src/${room}/*" "${SOURCE_DIR}/include/beautymap/${room}/*")
  if(NOT files)
    message(FATAL_ERROR "the room ${room} is empty")
  endif()
  foreach(file IN LISTS files)
    file(STRINGS "${file}" includes REGEX "^ *# *include *[<\"]")
    foreach(include IN LISTS includes)
      if(include MATCHES "[<\"](${ros})/")
        message(FATAL_ERROR "${file} is part of the core and has ${include}")
      endif()
      if(include MATCHES "[<\"](beautymap|\\.\\.)/([a-z_]+)/" AND
         NOT CMAKE_MATCH_2 IN_LIST allowed)
        message(FATAL_ERROR "${file}: the room ${room} must not include ${CMAKE_MATCH_2}")
      endif()
    endforeach()
  endforeach()
endforeach()
message("the core links no ROS library, includes no ROS header, and its rooms know what they may")
