/// The inverse of datagram.h: datagrams as a current MVN sends them, for the sender and for tests.
/// Pure functions, any thread.
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

/// `message` as bytes: type, item count and payload size follow from the body, the rest of the
/// header is taken as it is. ParseDatagram() of the result gives the same values back, in float
/// precision. Ids of props and fingers follow the header's number of props (mvn-protocol.md 4.2).
/// Trackers take 68 bytes each if one of them has rates, else 44.
/// @pre at most 65511 bytes of payload and 255 items; props within the header's number of them.
std::string Encode(const Message& message);

/// Message types, by number: those to send.
using TypeSet = std::bitset<26>;

inline TypeSet MakeTypeSet(std::initializer_list<Type> types) {
  TypeSet set;
  for (const Type type : types) set.set(static_cast<std::size_t>(type));
  return set;
}
inline bool Contains(const TypeSet& types, Type type) {
  return types.test(static_cast<std::size_t>(type));
}

/// 02 20 21 22 24: all that a receiver needs for a person in motion.
const TypeSet& UsualTypes();

/// The datagrams of one sample, in the order of types; of `types` those that the sample has:
/// - 01 and 02: the body with its gloves and props.
/// - 03: the points of type 13, carried by the segments; where `skeleton` is given.
/// - 20 (22 items) where it has angles; 21 and 22 where it has derivatives; 24 where it has a CoM.
/// - 23: its trackers; else one on each of the 17 segments of a full suit, at the segment's origin
///   and turned as the segment, measuring what the derivatives say; nothing without derivatives.
/// - 25: its time of day, else that of its stamp.
std::vector<std::string> EncodeSample(const BodySample& sample, const TypeSet& types = UsualTypes(),
                                      const urdf::Skeleton* skeleton = nullptr);

/// 01 and 02 of tracked objects, as many as there are up to the last one present.
std::vector<std::string> EncodeObjects(const ObjectsSample& sample,
                                       const TypeSet& types = UsualTypes());

/// Type 12; and type 13: of a person with a skeleton in two parts (segments with props and fingers,
/// then points), of objects in one.
std::vector<std::string> EncodeCharacter(const Character& character);

/// The points of a skeleton that MVN has too, numbered and named as MVN does: the origin of the
/// pelvis, both sides of every joint, the ends of head, hands, heels and toes.
std::vector<ScalePoint> ScalePointsOf(const urdf::Skeleton& skeleton);

/// Segment origins in the world as type 13 has them: the T-pose (every segment frame identity),
/// standing on z = 0, pelvis above the origin.
std::array<Eigen::Vector3d, urdf::kSegmentCount> TPoseOrigins(const urdf::Skeleton& skeleton);

/// What to change in the header of a datagram that is otherwise sent on as it came.
struct HeaderPatch {
  std::optional<int> character;  // 0..255
  std::optional<std::uint32_t> sample_counter;
  std::optional<std::uint32_t> time_code_millis;
};

/// Writes `patch` over `datagram`; the other bytes stay. @pre it has a whole header.
void PatchHeader(const HeaderPatch& patch, std::string& datagram);

}  // namespace kinescope::mvn
