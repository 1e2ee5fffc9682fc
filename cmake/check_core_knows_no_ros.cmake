# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DLIBRARY=libbeautymap_core.so -DSOURCE_DIR=. -P check_core_knows_no_ros.cmake
# Fails when the core library links a ROS library, or when one of its files includes a header of ROS
# or of the layers above it (Debian has the ROS headers in /usr/include: the compiler finds them).
set(ros "ros[a-z]*|tf|tf2|tf2_[a-z]+|pcl_ros|pcl_conversions|[a-z_]+_msgs")
set(layers "beautymap/io|beautymap/offline|beautymap/ros|beautymap/simulation")

if(LIBRARY MATCHES "\\.so$")
  execute_process(COMMAND ldd "${LIBRARY}" OUTPUT_VARIABLE linked RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "ldd ${LIBRARY} failed")
  endif()
  if(linked MATCHES "lib(ros|tf2|cpp_common|xmlrpcpp|beautymap)[a-z_]*\\.so")
    message(FATAL_ERROR "the core library links ${CMAKE_MATCH_0}:\n${linked}")
  endif()
endif()

foreach(room base config matrix ground published evidence cleaner evaluation)
  file(GLOB files "${SOURCE_DIR}/src/${room}/*" "${SOURCE_DIR}/include/beautymap/${room}/*")
  list(APPEND core_files ${files})
endforeach()
foreach(file IN LISTS core_files)
  file(STRINGS "${file}" includes REGEX "^ *# *include *[<\"](${ros}|${layers})/")
  if(includes)
    message(FATAL_ERROR "${file} is part of the core and has ${includes}")
  endif()
endforeach()
message("the core links no ROS library and includes no ROS header")
