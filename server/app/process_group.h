/// Runs a program beside this one, in a process group of its own: what it starts ends with it.
/// Reads what it writes. Linux; the thread that creates it also ends it, since the program is
/// killed when that thread ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::app {

class ProcessGroup {
 public:
  using Clock = std::chrono::steady_clock;

  struct Settings {
    std::vector<std::string> command;      // [0]: path
    std::vector<std::string> environment;  // "NAME=value" to set, "NAME" to remove
    std::string folder;                    // in which it runs; "": the current one
    /// Whether it has a channel: its file descriptors 3, which it reads, and 4, which it writes.
    bool has_channel = false;
    /// Whether Read() and Send() end when the user stops this program. False: the caller looks
    /// after that, and may let it finish what it does.
    bool ends_on_stop = true;
  };

  /// @throws std::runtime_error if it cannot be started.
  explicit ProcessGroup(const Settings& settings);
  ~ProcessGroup();  // as End()
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Waits until it has written something or has closed all of its outputs, and reads that.
  /// @return false after `deadline`. @throws std::runtime_error if the user stops this program
  /// (Settings::ends_on_stop).
  [[nodiscard]] bool Read(Clock::time_point deadline);

  /// Writes to the channel. @return false if it has ended, or has not read all by `deadline`.
  /// @throws as Read().
  [[nodiscard]] bool Send(std::string_view bytes, Clock::time_point deadline);

  /// Sends it a signal, if it has not been waited for.
  void Signal(int signal) const;

  /// What came from the channel since the last call.
  std::string TakeReceived();
  /// The next whole line of what it wrote to standard output and error; nullopt: none yet.
  std::optional<std::string> TakeLine();
  /// It has closed all of its outputs, as a program does that ends.
  bool has_ended() const { return channel_ < 0 && log_ < 0; }
  bool has_channel() const { return channel_ >= 0; }

  /// Kills all that is left of it and waits for that. "exit code 3" or "signal 11 (Segmentation
  /// fault)": how it ended, by itself or thus. A second call returns the same.
  const std::string& End();

 private:
  void ReadLog();
  void ReadChannel();
  void DrainLog();
  void AwaitEnd() const;
  void StopIfUserStops() const;

  const bool ends_on_stop_;
  pid_t process_ = -1;
  int exit_ = -1;                // readable when the process has ended; -1: not known
  int channel_ = -1, log_ = -1;  // -1: closed
  bool has_closed_ = false;      // it has closed one of them
  std::string received_, lines_;
  std::string ending_;
};

}  // namespace kinescope::app
