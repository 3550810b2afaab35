#include "tests/system/kinescope_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "tests/system/kinescope_path.h"

namespace kinescope::testing {

ProgramResult Kinescope(std::vector<std::string> arguments,
                        const std::vector<std::string>& environment) {
  arguments.insert(arguments.begin(), KinescopePath());
  return RunProgram(arguments, environment);
}

void ExpectRefusal(const ProgramResult& result, const std::string& named) {
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, ::testing::HasSubstr(named));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(result.out, "");
}

std::string RestOfLine(Process& process, const std::string& text) {
  while (const auto line = process.ReadLine(std::chrono::seconds(30))) {
    const std::size_t at = line->find(text);
    if (at != std::string::npos) return line->substr(at + text.size());
  }
  ADD_FAILURE() << "it never said '" << text << "'";
  return "";
}

}  // namespace kinescope::testing
