/// Reads the messages of some topics of a ROS 1 bag in the order of their recorded time, and counts
/// the others. No ROS types; one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "server/ros/source/bag_reader.h"

namespace kinescope::ros_bridge {

/// `rosbag record` writes messages in the order in which its threads received them: within
/// milliseconds that of their recorded time. Scripts that merge bags write one after the other. So
/// messages are put in order within a window of kWindowBytes, about 40 s of a person: what is
/// further out of order is delivered late, never lost.
class BagMessages {
 public:
  static constexpr std::size_t kWindowBytes = 16 << 20;

  BagMessages(InputFile file, const BagReader::IsWanted& is_wanted);

  /// The next wanted message. False at the end; see ending().
  [[nodiscard]] bool Next(BagMessage& message);

  const BagReader::Ending& ending() const { return reader_.ending(); }
  std::uint64_t read() const { return read_; }  // messages, wanted or not
  /// Damaged records so far, by reason.
  const std::map<std::string, std::uint64_t>& defects() const { return reader_.defects(); }
  /// Messages that were not wanted so far.
  const std::map<const BagConnection*, std::uint64_t>& others() const { return others_; }
  /// Found so far, by the number that the bag gives them.
  const std::map<std::uint32_t, BagConnection>& connections() const {
    return reader_.connections();
  }

 private:
  void Fill();

  BagReader reader_;
  const BagReader::IsWanted is_wanted_;
  bool has_ended_ = false;
  std::multimap<std::int64_t, BagMessage> window_;  // by recorded time; equal: as in the file
  std::size_t window_bytes_ = 0;
  std::uint64_t read_ = 0;
  std::map<const BagConnection*, std::uint64_t> others_;
};

}  // namespace kinescope::ros_bridge
