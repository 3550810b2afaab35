/// The inverse of datagram.h: datagrams as a current MVN sends them, for the sender and for tests.
/// Pure functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "server/core/body_sample.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// `message` as bytes: type, item count and payload size follow from the body, the rest of the
/// header is taken as it is. ParseDatagram() of the result gives the same values back, in float
/// precision.
/// @pre the body is not NotNeeded; at most 65511 bytes of payload.
std::string Encode(const Message& message);

/// The datagrams of one sample, in MVN's order of types: 02; 20 (22 items) where it has angles; 21
/// and 22 where it has derivatives; 24 where it has a CoM.
std::vector<std::string> EncodeSample(const BodySample& sample);

/// Type 12, and type 13 in two parts (segments, then the end points of head, hands, feet and toes)
/// where the character has a skeleton.
std::vector<std::string> EncodeCharacter(const Character& character);

/// Segment origins in the world as type 13 has them: the T-pose (every segment frame identity),
/// standing on z = 0, pelvis above the origin.
std::array<Eigen::Vector3d, urdf::kSegmentCount> TPoseOrigins(const urdf::Skeleton& skeleton);

}  // namespace kinescope::mvn
