/// People out of a ROS 1 bag: the transforms on its /tf, joined to samples. Needs no ROS master. In
/// a build without ROS the function exists and says so.
#pragma once

#include <memory>
#include <string>

#include "core/source.h"

namespace kinescope::ros_bridge {

/// `path`: a bag, also inside .xz, .gz, .bz2 or .zst (unpacked to a temporary file, because a bag
/// is read by seeking). Its chunks may be uncompressed, bz2 or lz4.
///
/// - Frames are found by name, whatever stands around it (people_frames.h), in the first ten
/// seconds
///   of /tf, which are read when opening; people who come later are found later. Every pose is
///   taken relative to the frame that the person's own tree hangs on, flat or chained; frames of
///   /tf_static are part of every sample.
/// - A sample is one whole set of the 23 segments, in one message or many. A set that another
///   follows before it is whole is rejected: "sample without all 23 segments".
/// - Arms may be in segment frames (T-pose) or link frames (N-pose): the first sample tells which,
///   by the direction in which each upper arm and forearm has its next joint.
/// - stamp = the header's, when it is within a day of the time at which the bag recorded it, and
///   later than the one before. From the first that is not, the bag's own times are taken. The same
///   stamp again is the same sample again: a `duplicate`. An earlier stamp is a `restart`.
/// - counter = sample number, from 0; time code = time since the person's first sample. A bag has
/// no
///   derivatives, no CoM; the Character has a skeleton, measured on the first sample, and again
///   when the lengths change for good (skeleton_watch.h).
/// - counters(): a datagram is a message; other topics are `ignored` by name, unread.
///
/// One thread uses the source.
/// @throws SourceError naming the file, what is wrong and what would help. Poll() throws it, too.
std::unique_ptr<Source> OpenBag(const std::string& path);

}  // namespace kinescope::ros_bridge
