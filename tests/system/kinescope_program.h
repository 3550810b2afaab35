/// The program that was built, run as its users run it, and what a refusal has to look like.
#pragma once

#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/system/run_program.h"

namespace kinescope::testing {

/// `arguments` without the program's own name. `environment`: "NAME=value" to add.
ProgramResult Kinescope(std::vector<std::string> arguments,
                        const std::vector<std::string>& environment = {});

/// Expects exit code 2, one line on standard error that has `named`, nothing on standard output.
void ExpectRefusal(const ProgramResult& result, const std::string& named);

/// Reads on to the line of `process` that has `text`; what follows it there. Fails the test and
/// gives "" where no such line comes within 30 s.
std::string RestOfLine(Process& process, const std::string& text);

}  // namespace kinescope::testing
