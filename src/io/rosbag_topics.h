// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rosbag_files.h"

namespace beautymap {

/// The only topic with clouds, or the wanted one.
/// @throws InputError with the candidates where that is none or several.
RosbagFiles::Topic chooseCloudTopic(const RosbagFiles& files, const std::string& wanted);

/// @throws InputError with the candidates where that topic has no odometry.
RosbagFiles::Topic chooseOdometryTopic(const RosbagFiles& files, const std::string& wanted);

/// The frame of a topic's first readable cloud.
std::string frameOfClouds(const RosbagFiles& files, const RosbagFiles::Topic& topic);

/// One line a topic with odometry: name, type, frame, count.
std::string odometryCandidates(const RosbagFiles& files);

/// Selects the messages of a topic.
RosbagFiles::Query messagesOf(const RosbagFiles::Topic& topic);

}  // namespace beautymap
