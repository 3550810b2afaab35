/// A Chromium that draws without a window and is steered over a pipe (--remote-debugging-pipe), so
/// that no port is open and nothing is left of it: its files are in a temporary folder. One thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/system/scratch_folder.h"
#include "server/app/golden/page_messages.h"
#include "server/app/process_group.h"

namespace kinescope::app {

/// The program of KINESCOPE_CHROMIUM, else chromium-headless-shell, chromium, chromium-browser,
/// google-chrome or google-chrome-stable of PATH. @throws std::runtime_error with what to do if
/// there is none.
std::filesystem::path FindChromium();

/// A call was refused by the browser; what() is its reason.
class CallRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class PageBrowser {
 public:
  using Clock = ProcessGroup::Clock;

  /// @param most_bytes  of a message of it
  /// @param limit  after which all functions give up
  /// @throws std::runtime_error if it does not start, and from all other functions, with what was
  /// waited for, if the limit has passed, it ends, or the user stops this program.
  PageBrowser(const std::filesystem::path& chromium, std::size_t most_bytes,
              std::chrono::milliseconds limit);

  /// "Chromium 131.0.6778.85".
  const std::string& version() const { return version_; }

  /// Receives the events of the session while this object waits; may Post().
  using OnEvent = std::function<void(const BrowserMessage& event)>;

  /// All later calls are for this page of it, and its events are received.
  void UseSession(std::string session, OnEvent on_event);

  /// The result. @throws also CallRefused.
  nlohmann::json Call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object());
  /// Does not wait for the result.
  void Post(const std::string& method, const nlohmann::json& parameters);
  /// Until events have made it true.
  void WaitUntil(const std::function<bool()>& is_so);

  /// What is waited for, for the message after the limit: "it to be loaded".
  void SetStage(std::string stage) { stage_ = std::move(stage); }

 private:
  std::vector<std::string> CommandOf(const std::filesystem::path& chromium) const;
  std::int64_t Send(const std::string& method, const nlohmann::json& parameters);
  BrowserMessage NextMessage();
  void TakeEvent(const BrowserMessage& message) const;
  void ReadMore();
  [[noreturn]] void ThrowEnd();

  const std::chrono::milliseconds limit_;
  const Clock::time_point deadline_;
  ScratchFolder folder_;  // before the process that uses it
  ProcessGroup process_;
  MessageSplitter messages_;
  std::int64_t calls_ = 0;
  std::string session_, version_, stage_ = "the start of Chromium";
  OnEvent on_event_;
};

}  // namespace kinescope::app
