/// A folder with one accepted golden case, and the commands on it. For tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/shared_data.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope::testing {

/// As on a person's machine, also where these tests run in CI.
inline ProgramResult Golden(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "golden");
  return Kinescope(std::move(arguments), {"CI="});
}

class GoldenCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 320x180\n");
    ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  }
  void WriteCase(const std::string& name, const std::string& yaml) const {
    std::ofstream(case_ / (name + ".yaml")) << yaml;
  }
  ProgramResult Check(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"check", case_, "--out", case_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Golden(arguments);
  }

  void ReplaceInLock(const std::string& before, const std::string& now) const {
    std::string lock = ReadFile(case_ / "golden.lock");
    const std::size_t at = lock.find(before);
    ASSERT_NE(at, std::string::npos) << lock;
    std::ofstream(case_ / "golden.lock") << lock.replace(at, before.size(), now);
  }
  void WritePointer(const std::string& sha256) const {
    std::ofstream(case_ / "bend.png")
        << "version https://git-lfs.github.com/spec/v1\noid sha256:" << sha256 << "\nsize 5\n";
  }
  void AddToCase(const std::string& line) const {
    std::ofstream(case_ / "bend.yaml", std::ios::app) << line << "\n";
  }

  TempFolder folder_;
  std::filesystem::path case_ = folder_.path();
};

}  // namespace kinescope::testing
