/// Reads people from a ROS 1 bag: assembles the transforms on its /tf to samples, with the
/// velocities and accelerations of link_states. Needs no ROS master. In a build without ROS the
/// function throws a SourceError.
#pragma once

#include <memory>
#include <string>

#include "core/graph_view.h"
#include "core/source.h"

namespace kinescope::ros_bridge {

/// `path`: a bag of format 2.0, also compressed as .xz, .gz, .bz2, .zst or .lz4. Its chunks may be
/// uncompressed, bz2 or lz4. It is decompressed while it is read, into memory of a limited size and
/// no temporary file.
///
/// - The end of the bag is not needed: one that was not closed (`.bag.active`) or is truncated is
///   read up to its last complete message, with a warning. Damaged records are counted by reason in
///   `rejected`. If a length is damaged, reading goes on with the next chunk; if there is none,
///   Poll() throws after the samples before the damage.
/// - Messages are used in the order of their recorded time, also if they are stored in another one
///   (bag_messages.h).
/// - Frames are found by name, with any prefix or suffix (people_frames.h), in the first ten
///   seconds of /tf, which are read on opening; people who appear later are found later. Every pose
///   is relative to the root frame of the person's own tree, flat or chained; frames of /tf_static
///   are part of every sample.
/// - A sample is one complete set of the 23 segments, in one message or many. A set that is
///   followed by another before it is complete is rejected: "sample without all 23 segments".
/// - Arms may be in segment frames (T-pose) or link frames (N-pose). The first sample decides, by
///   the direction from each upper arm and forearm to its next joint.
/// - stamp = that of the header, if it is within a day of the time at which the bag recorded it and
///   later than the one before. From the first stamp that is not, the times of the bag are used. An
///   equal stamp is the same sample again: a `duplicate`. An earlier stamp is a `restart`.
/// - counter = sample number, from 0, and time code = time since the first sample of anyone; who
///   comes later goes on where the others are. A bag has
///   no CoM, and derivatives only with link_states (motion_joiner.h); the Character has a skeleton,
///   measured on the first sample, and again when the lengths change permanently
///   (skeleton_watch.h).
/// - A bag without people on /tf has one person for each topic of LinkStateArray, whatever its
/// name.
/// - A bag without any person, if `view` does without and something of it is shown: its messages
///   make moments in place of samples, in the frame of its TF that most others hang on.
/// - Markers of other nodes, and what `view` names, are delivered with the samples
///   (bag_surroundings.h). Its robots have no parameters: a bag has none.
/// - counters(): a datagram is a message, or a damaged record; other topics are counted in
/// `ignored`
///   by name when they are passed, unread.
///
/// A source is used by one thread.
/// @throws SourceError with the file, the error and the remedy; so does Poll().
[[nodiscard]] std::unique_ptr<Source> OpenBag(const std::string& path, const GraphView& view = {});

}  // namespace kinescope::ros_bridge
