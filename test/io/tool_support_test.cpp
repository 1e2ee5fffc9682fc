// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/io/tool_support.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <csignal>

#include "beautymap/config/config.h"

namespace beautymap {
namespace {

class RunTool : public testing::Test {
 protected:
  RunTool() { addSourceOptions(app_, inputs_, options_); }

  /// The exit code; what was written to stderr is in error_.
  int run(
      std::vector<std::string> arguments, const std::function<void()>& tool = [] {}) {
    arguments.insert(arguments.begin(), "beautymap_test");
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    const int code = runTool(app_, static_cast<int>(argv.size()), argv.data(), tool);
    error_ = testing::internal::GetCapturedStderr();
    output_ = testing::internal::GetCapturedStdout();
    return code;
  }

  CLI::App app_{"A test.", "beautymap_test"};
  std::vector<std::string> inputs_;
  SourceOptions options_;
  std::string error_;
  std::string output_;
};

TEST_F(RunTool, ReadsEverySourceOption) {
  EXPECT_EQ(run({"a.bag", "b.bag", "--map-frame", "m", "--cloud-topic", "c", "--sensor-frame", "s",
                 "--odom-topic", "o", "--start", "1.5", "--duration", "2.5", "--stride", "3"}),
            0);
  EXPECT_EQ(inputs_, (std::vector<std::string>{"a.bag", "b.bag"}));
  EXPECT_EQ(options_.map_frame, "m");
  EXPECT_EQ(options_.cloud_topic, "c");
  EXPECT_EQ(options_.sensor_frame, "s");
  EXPECT_EQ(options_.odom_topic, "o");
  EXPECT_EQ(options_.start_s, 1.5);
  EXPECT_EQ(options_.duration_s, 2.5);
  EXPECT_EQ(options_.stride, 3);
}

TEST_F(RunTool, ExitsWithTwoForAWrongCommandLine) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"a.bag", "--no-such-option"}), 2);
  EXPECT_EQ(run({"a.bag", "--stride", "0"}), 2);
  EXPECT_NE(error_.find("stride"), std::string::npos);
  EXPECT_EQ(run({"a.bag", "--start", "-1"}), 2);
}

TEST_F(RunTool, ExitsWithZeroAfterHelp) {
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_NE(output_.find("--sensor-frame"), std::string::npos);
}

TEST_F(RunTool, ExitsWithTwoAndOneLineForAnUnusableInput) {
  EXPECT_EQ(run({"a.bag"}, [] { throw InputError("a.bag: is no bag"); }), 2);
  EXPECT_EQ(error_, "beautymap_test: a.bag: is no bag\n");
  EXPECT_EQ(run({"a.bag"}, [] { throw ConfigError("res_g is 0"); }), 2);
}

TEST_F(RunTool, ExitsWithOneForAnythingUnexpected) {
  EXPECT_EQ(run({"a.bag"}, [] { throw std::runtime_error("oops"); }), 1);
  EXPECT_EQ(error_, "beautymap_test: unexpected error: oops\n");
}

TEST_F(RunTool, RunsDestructorsAfterCtrlC) {
  struct Output {
    bool& removed;
    ~Output() { removed = true; }
  };
  bool removed = false;
  bool finished = false;
  EXPECT_EQ(run({"a.bag"},
                [&] {
                  const Output output{removed};
                  Progress progress("testing", 2);
                  progress.step();
                  std::raise(SIGINT);
                  progress.step();
                  finished = true;
                }),
            130);
  EXPECT_TRUE(removed);
  EXPECT_FALSE(finished);
}

TEST(Progress, EndsWithOnePlainLineWithoutATerminal) {
  testing::internal::CaptureStderr();
  Progress progress("testing", 3);
  for (int i = 0; i < 3; ++i) progress.step();
  progress.finish();
  progress.finish();
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(text.find("testing 3/3, "), 0U) << text;
  EXPECT_NE(text.find("scans/s"), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

class SkippingSource : public ScanSource {
 public:
  bool next(SourceScan&) override {
    skip("empty cloud", "scan at 3 s");
    skip("empty cloud", "scan at 4 s");
    skip("stamp 0", "scan 7");
    return false;
  }
  void rewind() override {}
  std::size_t size() const override { return 3; }
  std::vector<std::string> describe() const override { return {}; }
};

TEST(PrintSkipped, NamesEveryReasonWithItsFirstExample) {
  SkippingSource source;
  SourceScan scan;
  testing::internal::CaptureStderr();
  printSkipped(source);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  source.next(scan);
  EXPECT_EQ(countSkipped(source), 3U);
  testing::internal::CaptureStderr();
  printSkipped(source);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("skipped 3 of 3 scans"), std::string::npos) << text;
  EXPECT_NE(text.find("2 x empty cloud"), std::string::npos) << text;
  EXPECT_NE(text.find("scan at 3 s"), std::string::npos) << text;
  EXPECT_EQ(text.find("scan at 4 s"), std::string::npos) << text;
}

}  // namespace
}  // namespace beautymap
