# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the other scripts: where things are, and an environment that does not depend on the
# caller's (a foreign python3 first on PATH breaks catkin, and HOME may be unset).
# shellcheck shell=bash

root_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# shellcheck disable=SC2034
build_dir=$root_dir/build

export PATH=/usr/bin:/bin:/usr/sbin:/sbin
unset PYTHONHOME PYTHONPATH VIRTUAL_ENV CONDA_PREFIX PYENV_VERSION
export PYTHONNOUSERSITE=1  # what was installed with pip --user is not what the distribution tested
export LC_ALL=C.UTF-8

say() { echo "${0##*/}: $*"; }
die() {
  echo "${0##*/}: $*" >&2
  exit 1
}

# ROS of Ubuntu 20.04; on Debian ROS is in /usr and needs no setup file.
source_ros() {
  if [[ -f /opt/ros/noetic/setup.bash ]]; then
    set +u  # the setup files read variables that are not set
    # shellcheck disable=SC1091
    source /opt/ros/noetic/setup.bash
    set -u
  fi
}

# Parallel compilers: one for each core, and 1.5 GB of memory for each (PCL's headers are large).
build_jobs() {
  local cores memory_mb jobs
  cores=$(nproc)
  memory_mb=$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)
  jobs=$((memory_mb / 1500))
  ((jobs <= cores)) || jobs=$cores
  ((jobs >= 1)) || jobs=1
  echo "$jobs"
}
