// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <rosbag/view.h>

#include "beautymap/io/pcd_stream.h"
#include "beautymap/io/scan_sink.h"
#include "io_test_helpers.h"

namespace beautymap {
namespace test {
namespace {

/// The recorded drive that is shared between developers; not part of the package.
std::string drivePath() {
  const char* const shared = std::getenv("BEAUTYMAP_SHARED");
  const fs::path folder =
      shared != nullptr ? fs::path(shared) : fs::path(BEAUTYMAP_SOURCE_DIR) / "../shared";
  return (folder / "data/kitti_0005.bag").string();
}

/// The first clouds and transforms of the bag, read without the code under test.
struct Reference {
  std::vector<sensor_msgs::PointCloud2> clouds;
  std::map<ros::Time, geometry_msgs::Transform> poses;

  Reference(const std::string& path, std::size_t scans) {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag);
    for (const auto& message : view) {
      // A scan's transform may be recorded behind it.
      if (clouds.size() > scans) return;
      if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>()) {
        clouds.push_back(*cloud);
      } else if (const auto tf = message.instantiate<tf2_msgs::TFMessage>()) {
        for (const auto& transform : tf->transforms) {
          poses[transform.header.stamp] = transform.transform;
        }
      }
    }
  }

  Eigen::Isometry3d pose(std::size_t scan) const {
    const auto& transform = poses.at(clouds[scan].header.stamp);
    const auto& t = transform.translation;
    const auto& q = transform.rotation;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
    pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    return pose;
  }
};

TEST(RealDrive, BecomesAPcdFolderWithTheSamePointsPosesAndLabels) {
  const std::string drive = drivePath();
  if (!fs::exists(drive)) GTEST_SKIP() << drive << " is not there";
  constexpr std::size_t kScans = 3;
  const TempFolder folder;
  SourceOptions options;
  options.moving_labels = {1, 2};
  options.duration_s = 0.25;
  const auto source = openScanSource({drive}, options);
  {
    const auto sink = openScanSink(folder / "out", {}, *source);
    SourceScan scan;
    std::size_t scans = 0;
    while (source->next(scan)) {
      sink->write(scan);
      ++scans;
    }
    ASSERT_EQ(scans, kScans);
    sink->close();
  }
  const Reference reference(drive, kScans);
  const auto truth = readPcd(folder / "out/gt_cloud.pcd");
  std::size_t first = 0;
  for (std::size_t s = 0; s < kScans; ++s) {
    const auto& message = reference.clouds.at(s);
    const Eigen::Isometry3d pose = reference.pose(s);
    const std::string path = folder / ("out/pcd/00000" + std::to_string(s) + ".pcd");
    const auto cloud = readPcd(path);
    EXPECT_LT((readPcdHeader(path).origin - pose.translation()).norm(), 1e-9);
    ASSERT_EQ(pointCount(cloud), message.width);
    sensor_msgs::PointCloud2ConstIterator<float> x(message, "x");
    sensor_msgs::PointCloud2ConstIterator<float> intensity(message, "intensity");
    sensor_msgs::PointCloud2ConstIterator<std::uint8_t> label(message, "label");
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pointCount(cloud); ++i, ++x, ++intensity, ++label) {
      const Eigen::Vector3d expected = pose * Eigen::Vector3d(x[0], x[1], x[2]);
      // Half a unit in the last place of float32 below 128 m, and a little for the order of sums.
      const bool same_point = (pointAt(cloud, i) - expected).cwiseAbs().maxCoeff() < 4e-6 &&
                              pointAt(truth, first + i) == pointAt(cloud, i);
      const bool same_fields = FieldReader(cloud, "intensity")(i) == *intensity &&
                               FieldReader(cloud, "label")(i) == (*label > 0 ? 1 : 0);
      const bool same_truth = (FieldReader(truth, "intensity")(first + i) == 1.0) == (*label > 0);
      wrong += same_point && same_fields && same_truth ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0U) << "in scan " << s;
    first += pointCount(cloud);
  }
  EXPECT_EQ(pointCount(truth), first);
}

}  // namespace
}  // namespace test
}  // namespace beautymap
