/// Writes datagrams as a current MVN sends them; the inverse of datagram.h. Used by the sender and
/// by tests. Pure functions, any thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/body_sample.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// `message` as bytes. Type, item count and payload size follow from the body, the rest of the
/// header is used as given. ParseDatagram() of the result returns the same values, in float
/// precision. The ids of props and fingers follow from their numbers in the header (mvn-protocol.md
/// 4.2). Trackers have 68 bytes each if one of them has rates, else 44.
/// @pre at most 65511 bytes of payload and 255 items; no more props than the header states.
std::string Encode(const Message& message);

/// A set of message types, indexed by number.
using TypeSet = std::bitset<26>;

inline TypeSet MakeTypeSet(std::initializer_list<Type> types) {
  TypeSet set;
  for (const Type type : types) set.set(static_cast<std::size_t>(type));
  return set;
}
inline bool Contains(const TypeSet& types, Type type) {
  return types.test(static_cast<std::size_t>(type));
}

/// 02 20 21 22 24: everything that a receiver needs to show a person in motion.
const TypeSet& UsualTypes();

/// The datagrams of one sample, in the order of types: those in `types` for which the sample has
/// data.
/// - 01 and 02: the body with its gloves and props.
/// - 03: `landmarks`, moved with the segments; at most 255.
/// - 20 (22 items) if it has angles; 21 and 22 if it has derivatives; 24 if it has a CoM.
/// - 23: its trackers. Without trackers: one on each of the 17 segments of a full suit, at the
///   origin and with the orientation of the segment, computed from the derivatives; none without
///   derivatives.
/// - 25: its time of day, else that of its stamp.
std::vector<std::string> EncodeSample(const BodySample& sample, const TypeSet& types = UsualTypes(),
                                      const urdf::Landmarks& landmarks = {});

/// 01 and 02 of tracked objects, up to the last one present.
std::vector<std::string> EncodeObjects(const ObjectsSample& sample,
                                       const TypeSet& types = UsualTypes());

/// Type 12 and type 13. For a person with a skeleton, 13 has several parts (segments with props and
/// fingers, then LandmarksToSend()); for objects it has one.
std::vector<std::string> EncodeCharacter(const Character& character);

/// The points of a person for types 03 and 13: those that came with the skeleton; if none came, its
/// joints, which are known, without the ends of head, hands and feet, which are estimated.
urdf::Landmarks LandmarksToSend(const Character& character);

/// Segment origins in type 13, world, m: the T-pose (every segment frame is identity), standing on
/// z = 0, pelvis above the origin.
std::array<Eigen::Vector3d, urdf::kSegmentCount> TPoseOrigins(const urdf::Skeleton& skeleton);

/// Header fields to replace in a datagram that is otherwise sent unchanged.
struct HeaderPatch {
  std::optional<int> character;  // 0..255
  std::optional<std::uint32_t> sample_counter;
  std::optional<std::uint32_t> time_code_millis;
};

/// Applies `patch` to `datagram`; all other bytes stay. @pre it has a complete header.
void PatchHeader(const HeaderPatch& patch, std::string& datagram);

}  // namespace kinescope::mvn
