// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace beautymap {

/// Point-level counts of a cleaned map, and the dynamic-map benchmark's scores in percent.
struct Score {
  std::uint64_t static_points = 0;
  std::uint64_t dynamic_points = 0;
  std::uint64_t kept_static = 0;
  std::uint64_t kept_dynamic = 0;

  double SA() const;  ///< static accuracy: kept static / all static
  double DA() const;  ///< dynamic accuracy: removed dynamic / all dynamic
  double AA() const;  ///< sqrt(SA DA)
  double HA() const;  ///< 2 SA DA / (SA + DA)
};

/// Scores a cleaned map against labelled points: a ground-truth point is kept when the cleaned map
/// has a point nearer than the radius. First every ground-truth point is added, then the cleaned
/// map's points are shown. Memory grows with the different positions that are not known to be kept
/// when they are added.
class Evaluator {
 public:
  /// @param radius_m  [m], > 0
  explicit Evaluator(double radius_m = 0.05);

  /// Ground-truth points that the cleaned map holds itself.
  void addKept(bool moving, std::uint64_t count = 1);
  /// A ground-truth point [m] that may or may not have a point of the cleaned map near it.
  /// Non-finite ones are not scored.
  void addUnmatched(const Eigen::Vector3d& point, bool moving);

  /// Between the last ground-truth point and the first one of the cleaned map.
  void finishTruth();
  /// Points of the cleaned map [m]; blocks of some thousands are fastest. Several threads may show
  /// points at once: their order does not matter.
  void showCleaned(const std::vector<Eigen::Vector3d>& points);

  Score score() const;

 private:
  /// A ground-truth position, and how many points of each label are there.
  struct Unmatched {
    std::uint64_t cell;
    Eigen::Vector3d point;
    std::uint32_t static_count;
    std::uint32_t moving_count;
  };
  /// The points of a part of the cells.
  class Shelf {
   public:
    /// Points of one cell; empty for begin == end.
    struct Run {
      std::uint64_t cell = 0;
      std::uint32_t begin = 0, end = 0;
    };

    void add(const Unmatched& unmatched);
    void finish();
    /// Where find() will look first.
    const Run* firstPlace(std::uint64_t cell) const;
    const Run& find(std::uint64_t cell) const;
    /// Marks the points of a run that are near.
    void match(const Run& run, const Eigen::Vector3d& point, double radius_m);
    const std::vector<Unmatched>& points() const { return points_; }
    void addKeptTo(Score& score) const;

   private:
    void mergeEqual();

    std::vector<Unmatched> points_;
    std::size_t merged_ = 0;  ///< so many at the front are sorted and different
    std::vector<Run> runs_;   ///< hashed
    std::vector<std::atomic<bool>> kept_;
  };
  /// The cells within the radius of the points, one bit each. Most points of a cleaned map are far
  /// from all that was removed, and this tells so after a look at a bit that is mostly in a near
  /// cache. Cells that differ only in their indices' upper bits share one.
  class NearCells {
   public:
    explicit NearCells(double radius_m);
    void insert(const Eigen::Vector3d& point);
    /// Tells which of a block's points may have an inserted one within the radius.
    /// @param selected  gets their places among the points; room for all
    /// @return how many they are
    std::size_t select(const Eigen::Vector3d* points, std::size_t count,
                       std::uint32_t* selected) const;

   private:
    double radius_m_;
    double cells_per_m_;
    std::vector<std::uint64_t> words_;
  };
  /// A set of cells that tells at once what it does not hold; cubes that share a line of bits may
  /// make it hold more.
  class CellSet {
   public:
    CellSet();
    void insert(std::uint64_t cell);
    bool mayHold(std::uint64_t cell) const;

   private:
    /// The cells of a cube, in one cache line.
    struct alignas(64) Line {
      std::array<std::uint64_t, 8> words{};
    };
    std::vector<Line> lines_;
  };

  Shelf& shelfOf(std::uint64_t cell);
  std::uint64_t cellOf(const Eigen::Vector3d& point) const;
  template <typename F>
  void forEachCellInReach(const Eigen::Vector3d& point, F f) const;

  double radius_m_;
  double cells_per_m_;
  Score known_;  ///< all points, and those that are kept without a search
  std::vector<Shelf> shelves_;
  NearCells near_;    ///< around the unmatched points
  CellSet occupied_;  ///< cells with unmatched points
};

}  // namespace beautymap
