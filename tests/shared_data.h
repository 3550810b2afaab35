/// Finds the real recordings for tests that use them. They are not part of this repository; set
/// KINESCOPE_SHARED_DATA in the environment, or keep them in ../shared/data.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace kinescope::testing {

std::filesystem::path SharedData(const std::string& file);

inline std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace kinescope::testing

/// Skips the test, visibly, if the recording is missing. This is not a failure: the licences of the
/// recordings do not allow their distribution.
#define KINESCOPE_NEEDS_SHARED_DATA(file)                               \
  if (!std::filesystem::exists(::kinescope::testing::SharedData(file))) \
  GTEST_SKIP() << "real recording " << ::kinescope::testing::SharedData(file) << " is absent"
