// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/config/config.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "beautymap/cleaner/map_cleaner.h"
#include "test_scenes.h"

namespace beautymap {
namespace {

namespace fs = std::filesystem;

/// A file that is gone at the end of the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content)
      : path_(fs::temp_directory_path() /
              ("beautymap_config_test_" + std::to_string(getpid()) + ".yaml")) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { fs::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

Config load(const std::string& yaml) { return loadConfig(TemporaryFile(yaml).path()); }

/// What a ConfigError says; empty when nothing is thrown.
std::string errorOf(const std::function<void()>& f) {
  try {
    f();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string errorOfSetting(const std::string& assignment) {
  return errorOf([&] {
    Config config;
    setParameter(config, assignment);
  });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string valueOf(const Config& config, const std::string& name) {
  for (const ParameterInfo& p : listParameters(config)) {
    if (p.name == name) return p.value;
  }
  return "no such parameter";
}

bool isBool(const ParameterInfo& p) { return p.min == "false"; }
bool isChoice(const ParameterInfo& p) { return !p.choices.empty(); }
bool isInteger(const ParameterInfo& p) {
  return p.unit == "bits" || p.unit == "columns" || p.unit == "beams" || p.unit == "scans" ||
         p.unit == "gaps";
}

void expectEqual(const Config& a, const Config& b) {
  const std::vector<ParameterInfo> first = listParameters(a), second = listParameters(b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(first[i].value, second[i].value) << first[i].name;
}

TEST(Config, EveryParameterHasAMeaningAndADefaultInItsRange) {
  const std::vector<ParameterInfo> parameters = listParameters(Config());
  EXPECT_FALSE(parameters.empty());
  for (const ParameterInfo& p : parameters) {
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    EXPECT_EQ(errorOfSetting(p.name + "=" + p.value), "") << p.name;
  }
}

TEST(Config, EveryParameterTakesItsLimits) {
  for (const ParameterInfo& p : listParameters(Config())) {
    for (const std::string& limit : {p.min, p.max}) {
      Config config;
      setParameter(config, p.name + "=" + limit);
      EXPECT_EQ(valueOf(config, p.name), limit);
    }
  }
}

TEST(Config, EveryParameterIsRefusedOutsideItsRangeWithNameValueAndRange) {
  for (const ParameterInfo& p : listParameters(Config())) {
    if (isBool(p) || isChoice(p)) continue;
    const double step = isInteger(p) ? 1.0 : 0.001;
    for (const double value : {std::stod(p.min) - step, std::stod(p.max) + step, -1e300, 1e300}) {
      std::ostringstream written;
      written << std::setprecision(10) << value;
      const std::string error = errorOfSetting(p.name + "=" + written.str());
      EXPECT_TRUE(contains(error, p.name)) << error;
      EXPECT_TRUE(contains(error, written.str())) << error;
      EXPECT_TRUE(contains(error, "from " + p.min + " to " + p.max)) << error;
      EXPECT_TRUE(p.unit.empty() || contains(error, p.unit)) << error;
    }
  }
}

TEST(Config, ValuesOfAnotherTypeAreRefused) {
  for (const ParameterInfo& p : listParameters(Config())) {
    std::vector<std::string> values{"", "many", "1 2", ".nan", "nan", "[1]"};
    if (!isBool(p)) values.insert(values.end(), {".inf", "-.inf", "true", "1,5", "1m"});
    if (isInteger(p)) values.insert(values.end(), {"2.5", "99999999999"});
    if (isBool(p)) values.insert(values.end(), {"2", "0.5"});
    for (const std::string& value : values) {
      const std::string error = errorOfSetting(p.name + "=" + value);
      EXPECT_TRUE(contains(error, p.name)) << p.name << " took '" << value << "' " << error;
      const std::string choices = isBool(p) ? "true or false" : p.choices;
      EXPECT_TRUE(contains(error, choices.empty() ? p.max : choices)) << error;
    }
  }
}

TEST(Config, ARefusedValueChangesNothing) {
  for (const ParameterInfo& p : listParameters(Config())) {
    Config config;
    EXPECT_THROW(setParameter(config, p.name + "=nonsense"), ConfigError);
    expectEqual(config, Config());
  }
}

TEST(Config, UnknownNamesAreRefusedWithTheKnownOnes) {
  EXPECT_TRUE(contains(errorOfSetting("matrix.res_x=1"), "matrix.res_x"));
  EXPECT_TRUE(contains(errorOfSetting("matrix.res_x=1"), "res_g"));
  EXPECT_TRUE(contains(errorOfSetting("matrx.res_g=1"), "matrx"));
  EXPECT_TRUE(contains(errorOfSetting("matrx.res_g=1"), "coarse_ground"));
  EXPECT_NE(errorOfSetting("matrix.RES_G=1"), "");
  EXPECT_NE(errorOfSetting("matrix.=1"), "");
  EXPECT_NE(errorOfSetting("matrix.res_g.x=1"), "");
  EXPECT_NE(errorOfSetting("matrix.res=1"), "") << "a part of a name";
  EXPECT_TRUE(contains(errorOf([] { load("matrix: {res_g: 1, cells: 5}"); }), "matrix.cells"));
  EXPECT_TRUE(contains(errorOf([] { load("matrix: {res_g: 1}\ngrid: {a: 5}"); }), "grid"));
  EXPECT_NE(errorOf([] { load("matrix: {[1, 2]: 5}"); }), "");
}

TEST(Config, TwoKnownNamesInOneKeyAreNotAKnownName) {
  EXPECT_NE(errorOfSetting("scan.min_range, max_range=1"), "");
  EXPECT_NE(errorOf([] { load("\"scan, matrix\": {res_g: 1}"); }), "");
}

TEST(Config, AKeyThatStandsTwiceIsRefused) {
  EXPECT_NE(errorOf([] { load("matrix: {res_g: 1.0, res_g: 2.0}"); }), "");
  EXPECT_NE(errorOf([] { load("matrix: {res_g: 1.0}\nmatrix: {res_h: 0.5}"); }), "");
}

TEST(Config, AnAssignmentNeedsAGroupANameAndAValue) {
  for (const char* assignment : {"", "=", ".", "res_g=1", "matrix.res_g", "matrix=1", "a=b.c"}) {
    EXPECT_NE(errorOfSetting(assignment), "") << assignment;
  }
}

TEST(Config, FilesThatAreNoConfigurationAreRefused) {
  EXPECT_TRUE(
      contains(errorOf([] { loadConfig("/does/not/exist.yaml"); }), "/does/not/exist.yaml"));
  for (const char* content :
       {"just words", "- 1\n- 2\n", "matrix: 5", "matrix: [1, 2]", "a: b: c", "matrix:\n\t- {",
        "\x01\x02\x7f", "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n",
        "#ROSBAG V2.0\n\r\x01\x03op=\x03"}) {
    const TemporaryFile file(content);
    EXPECT_TRUE(contains(errorOf([&] { loadConfig(file.path()); }), file.path())) << content;
  }
}

TEST(Config, AFolderIsNoConfiguration) {
  EXPECT_NE(errorOf([] { loadConfig(fs::temp_directory_path().string()); }), "");
}

TEST(Config, WhatAFileDoesNotNameKeepsItsDefault) {
  Config expected;
  expected.matrix.res_h = 0.125;
  expected.fine_ground.enabled = false;
  expectEqual(load("matrix: {res_h: 0.125}\nfine_ground:\n  enabled: false\nscan:\n"), expected);
  expectEqual(load(""), Config());
  expectEqual(load("# nothing but a comment\n"), Config());
}

TEST(Config, WhatIsWrittenIsReadAgain) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    Config config;
    for (const ParameterInfo& p : listParameters(Config())) {
      std::ostringstream value;
      if (isBool(p)) {
        value << std::boolalpha << random.chance(0.5);
      } else if (isChoice(p)) {
        value << (random.chance(0.5) ? p.min : p.max);
      } else if (isInteger(p)) {
        value << random.integer(std::stoi(p.min), std::stoi(p.max));
      } else {
        value << std::round(1e4 * random.uniform(std::stod(p.min), std::stod(p.max))) / 1e4;
      }
      setParameter(config, p.name + "=" + value.str());
    }
    config.scan.max_range = config.scan.min_range + 1.0;  // no contradictions
    config.matrix.res_h = config.fine_ground.bin_height + 1.0;
    config.matrix.res_g = config.matrix.room_res_g = std::max(0.2, config.matrix.res_g);
    config.matrix.bits_below = std::min(config.matrix.bits_below, config.matrix.n_bit - 1);
    expectEqual(load(toYaml(config)), config);
  }
}

TEST(Config, WrittenNumbersLoseNoDigit) {
  Config config;
  config.matrix.res_g = 1.0 / 3.0;
  config.fine_ground.ground_ratio = 0.99999999999;
  const Config read = load(toYaml(config));
  EXPECT_EQ(read.matrix.res_g, config.matrix.res_g);
  EXPECT_EQ(read.fine_ground.ground_ratio, config.fine_ground.ground_ratio);
}

TEST(Config, ContradictionsAreRefused) {
  Config ranges, bins;
  ranges.scan.min_range = ranges.scan.max_range = 20.0;
  bins.fine_ground.bin_height = 0.5;
  bins.matrix.res_h = 0.25;
  EXPECT_TRUE(contains(errorOf([&] { checkConfig(ranges); }), "scan.min_range"));
  EXPECT_TRUE(contains(errorOf([&] { checkConfig(bins); }), "fine_ground.bin_height"));
  EXPECT_THROW(MapCleaner cleaner(ranges), ConfigError);
  EXPECT_THROW(MapCleaner cleaner(bins), ConfigError);
  EXPECT_NE(errorOf([] { load("scan: {min_range: 30, max_range: 20}"); }), "");
  EXPECT_NO_THROW(checkConfig(Config()));
}

TEST(Config, LegalValuesThatTogetherNeedTensOfGigabytesAreRefusedWithTheirProduct) {
  Config config;
  config.scan.max_range = 1000.0;
  EXPECT_TRUE(contains(errorOf([&] { checkConfig(config); }), "scan.max_range = 1000"));
  config.matrix.room_res_g = 0.0;
  EXPECT_NO_THROW(checkConfig(config));
  config.matrix.res_g = 0.05;
  config.matrix.roi_size = 90.0;
  EXPECT_TRUE(contains(errorOf([&] { checkConfig(config); }), "4000 cells of 0.05 m"));
  Config voxel;
  voxel.online.map_voxel = 1e-30;
  EXPECT_TRUE(contains(errorOf([&] { checkConfig(voxel); }), "online.map_voxel"));
}

TEST(Config, ValuesSetInCodeAreCheckedToo) {
  Config bits, cell, nan;
  bits.matrix.n_bit = 65;
  cell.matrix.res_g = 0.0;
  nan.matrix.res_h = test::kNan;
  for (const Config& config : {bits, cell, nan}) EXPECT_THROW(checkConfig(config), ConfigError);
}

std::vector<fs::path> configFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(BEAUTYMAP_SOURCE_DIR) / "config")) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  return files;
}

TEST(Config, EveryFileOfThePackageLoads) {
  const std::vector<fs::path> files = configFiles();
  EXPECT_GE(files.size(), 3U) << "default, paper_kitti, paper_indoor";
  for (const fs::path& file : files) EXPECT_NO_THROW(loadConfig(file.string())) << file;
}

TEST(Config, DefaultsEqualTheDefaultFile) {
  const fs::path file = fs::path(BEAUTYMAP_SOURCE_DIR) / "config" / "default.yaml";
  ASSERT_TRUE(fs::exists(file));
  expectEqual(loadConfig(file.string()), Config());
  std::ifstream stream(file);
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  for (const ParameterInfo& p : listParameters(Config())) {
    EXPECT_TRUE(contains(text, p.name.substr(p.name.find('.') + 1) + ":"))
        << p.name << " does not stand in default.yaml";
  }
}

TEST(Config, ThePaperFilesHaveThePublishedSettings) {
  const std::string folder = (fs::path(BEAUTYMAP_SOURCE_DIR) / "config").string();
  const Config kitti = loadConfig(folder + "/paper_kitti.yaml");
  EXPECT_EQ(kitti.matrix.res_g, 1.0);
  EXPECT_EQ(kitti.matrix.res_h, 0.5);
  EXPECT_EQ(kitti.matrix.n_bit, 32);
  EXPECT_EQ(kitti.matrix.roi_size, 40.0);
  EXPECT_EQ(kitti.matrix.bits_below, 0);
  EXPECT_EQ(kitti.judgement.method, "published");
  const Config indoor = loadConfig(folder + "/paper_indoor.yaml");
  EXPECT_EQ(indoor.matrix.bits_below, 0);
  EXPECT_EQ(indoor.judgement.method, "published");
  EXPECT_EQ(indoor.matrix.res_g, 0.5);
  EXPECT_EQ(indoor.matrix.res_h, 0.2);
  EXPECT_EQ(indoor.matrix.n_bit, 32);
  EXPECT_EQ(indoor.matrix.roi_size, 10.0);
}

TEST(Config, ThereAreFewParametersAndFewerForUsers) {
  const std::vector<ParameterInfo> parameters = listParameters(Config());
  EXPECT_LE(parameters.size(), 40U);
  EXPECT_LE(std::count_if(parameters.begin(), parameters.end(),
                          [](const ParameterInfo& p) { return !p.symptom.empty(); }),
            10);
}

TEST(Config, TheReadmeListsEveryParameterWithDefaultRangeAndMeaning) {
  std::ifstream stream(fs::path(BEAUTYMAP_SOURCE_DIR) / "README.md");
  const std::string readme((std::istreambuf_iterator<char>(stream)),
                           std::istreambuf_iterator<char>());
  for (const ParameterInfo& p : listParameters(Config())) {
    const std::string row = "| `" + p.name + "` | " + p.value + " | " + p.range() + " | " +
                            p.meaning + (p.symptom.empty() ? " |" : " | " + p.symptom + " |");
    EXPECT_TRUE(contains(readme, row)) << "README.md lacks: " << row;
  }
}

}  // namespace
}  // namespace beautymap
