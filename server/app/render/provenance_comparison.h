/// Compares provenances. Pure functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/render/provenance.h"

namespace kinescope::app {

/// Whether two provenances describe the same pixels; ignores values that follow from others
/// (camera, size of the file, ...).
[[nodiscard]] bool DecideTheSame(const Json& a, const Json& b);

/// What is wrong if the options read other files `now` than `then`, in one sentence; "" if they
/// read the same ones. Of schema 1, only the inputs that both list are compared.
[[nodiscard]] std::string DifferenceOfInputs(const Json& then, const Json& now);

/// Why an earlier version drew other pixels than this one from `then`: the errors of that version
/// that affect these options, each a clause that follows "an earlier version, in which".
[[nodiscard]] std::vector<std::string> CorrectionsSince(const Json& then);

}  // namespace kinescope::app
