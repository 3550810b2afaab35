#include <algorithm>
#include <cstdio>

#include "server/mvn/inspect/character.h"

namespace kinescope::mvn {
namespace {

bool Has(const CharacterReport& character, Type type) {
  return std::any_of(character.types.begin(), character.types.end(),
                     [type](const TypeReport& t) { return t.type == static_cast<int>(type); });
}

std::string SwitchOn(Type type) { return "switch on " + DialogName(static_cast<int>(type)); }

std::string Percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f %%", 100 * fraction);
  return text;
}

// Why there is no person to show.
std::string NoPose(const CharacterReport& character) {
  const bool has_pose = Has(character, Type::kPose) || Has(character, Type::kEulerPose);
  if (has_pose) {
    return "no message contains all 23 segments: select the full body in MVN, and see the list "
           "\"Not used\"";
  }
  if (Has(character, Type::kLinear) != Has(character, Type::kAngular)) {
    const Type missing = Has(character, Type::kLinear) ? Type::kAngular : Type::kLinear;
    return "no pose: " + SwitchOn(Type::kPose) + ", or " + DialogName(static_cast<int>(missing));
  }
  return "no pose: " + SwitchOn(Type::kPose);
}

}  // namespace

std::vector<std::string> AdviceFor(const CharacterReport& character, bool has_scale,
                                   bool has_name) {
  std::vector<std::string> advice;
  if (character.samples == 0) advice.push_back(NoPose(character));
  const bool is_person = character.kind != CharacterKind::kObjects;
  if (character.samples > 0 && Has(character, Type::kEulerPose) && !Has(character, Type::kPose)) {
    advice.push_back("the pose is sent as Euler angles: " + SwitchOn(Type::kPose) +
                     ", which is smaller and has no gimbal lock");
  }
  if (is_person && !has_scale) {
    advice.push_back("segment lengths are assumed: " +
                     (Has(character, Type::kScale) ? DialogName(static_cast<int>(Type::kScale)) +
                                                         " was never received completely"
                                                   : SwitchOn(Type::kScale)));
  }
  if (!has_name) advice.push_back("no name and no colour: " + SwitchOn(Type::kMetaData));
  if (is_person && character.samples > 0) {
    const bool linear = character.quantities.count("velocity") > 0;
    const bool angular = character.quantities.count("angular velocity") > 0;
    if (!linear && !angular) {
      advice.push_back(
          "no velocities and accelerations: switch on Linear and Angular Segment Kinematics");
    } else if (!linear || !angular) {
      advice.push_back(
          std::string("only ") + (linear ? "linear" : "angular") +
          " velocities and accelerations: " + SwitchOn(linear ? Type::kAngular : Type::kLinear));
    }
  }
  if (character.has_old_header) {
    advice.push_back(
        "the message header is older than MVN 2018 (no payload size): update MVN to send gloves, "
        "props or several characters");
  }
  if (character.lost && *character.lost > 0) {
    const auto lost = static_cast<double>(*character.lost);
    advice.push_back(
        Percent(lost / (lost + static_cast<double>(character.frames))) +
        " of the frames are lost: use a network cable or TCP, or lower the stream rate");
  }
  return advice;
}

std::vector<std::string> AdviceFor(const InspectionReport& report) {
  std::vector<std::string> advice;
  const std::uint64_t strangers = report.transport ? report.transport->strangers : 0;
  if (strangers > 0) {
    advice.push_back(std::to_string(strangers) +
                     " datagrams or connections of senders that --from does not admit were "
                     "rejected; the log names the first: if it is the suit, correct --from");
  } else if (report.has_datagrams && report.datagrams == 0) {
    advice.push_back(report.is_live
                         ? "no datagrams received: in MVN, Options, Network Streamer, add this "
                           "machine's address and this port; open the port in the firewall"
                         : "the file contains no datagrams");
  }
  if (report.transport && report.transport->kernel_drops > 0) {
    advice.push_back(
        "datagrams were dropped because the receive buffer was full: raise net.core.rmem_max "
        "(sysctl), or reduce the CPU load");
  }
  return advice;
}

}  // namespace kinescope::mvn
