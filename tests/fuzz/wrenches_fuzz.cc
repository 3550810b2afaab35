// Any text as a file of measured forces, of the format that its first byte says: a SourceError or
// UsageError with a reason, or rows in order of time whose numbers are finite and within limits.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/wrenches/wrench_reader.h"

namespace wrenches_fuzz {
namespace {

using namespace kinescope;
using namespace kinescope::wrenches;

void CheckRows(WrenchReader& reader) {
  std::array<double, kWrenchBodyCount> newest;
  newest.fill(-std::numeric_limits<double>::infinity());
  double newest_of_all = newest[0];
  while (const auto row = reader.Next()) {
    KINESCOPE_CHECK(row->secs >= newest_of_all && row->secs > newest[At(row->body)]);
    newest_of_all = newest[At(row->body)] = row->secs;
    KINESCOPE_CHECK(row->force.cwiseAbs().maxCoeff() <= 1e5);
    KINESCOPE_CHECK(row->torque.cwiseAbs().maxCoeff() <= 1e5);
    KINESCOPE_CHECK(!row->point || row->point->cwiseAbs().maxCoeff() <= 1e3);
    if (IsHand(row->body)) continue;
    KINESCOPE_CHECK(row->force.z() >= -50 && (row->point || row->force.z() <= kMinGroundForce));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;  // fmemopen takes no empty buffer
  const bool is_mot = data[0] == 'm';
  WrenchSettings settings;
  if (is_mot) {
    settings.groups = {{"ground_force_1", WrenchBody::kRightFoot},
                       {"ground_force_2", WrenchBody::kLeftFoot}};
  }
  try {
    InputFile file(fmemopen(const_cast<std::uint8_t*>(data) + 1, size - 1, "rb"));
    const auto reader = ReadWrenches(std::move(file), "fuzz",
                                     is_mot ? WrenchFormat::kMot : WrenchFormat::kCsv, settings);
    CheckRows(*reader);
  } catch (const SourceError& error) {
    KINESCOPE_CHECK(std::string(error.what()).rfind("fuzz: ", 0) == 0);
  } catch (const UsageError& error) {
    KINESCOPE_CHECK(std::string(error.what()).find("wrench_bodies") != std::string::npos);
  }
  return 0;
}

}  // namespace wrenches_fuzz
