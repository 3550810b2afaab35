#include "server/app/serve/page_token.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/system/errors.h"
#include "server/http/access.h"

namespace kinescope::app {
namespace {

constexpr mode_t kForThisUser = S_IRUSR | S_IWUSR;
constexpr ssize_t kMaxFileBytes = 4096;

// False if the file exists.
bool MakeTokenFile(const std::string& origin, const std::string& file) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kForThisUser);
  if (descriptor < 0 && errno == EEXIST) return false;
  const std::string line = http::RandomToken() + "\n";
  const bool is_written = descriptor >= 0 && ::write(descriptor, line.data(), line.size()) ==
                                                 static_cast<ssize_t>(line.size());
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (is_written) return true;
  if (descriptor >= 0) ::unlink(file.c_str());
  throw UsageError(
      fmt::format("{}: cannot make this file: {}; choose another", origin, std::strerror(reason)));
}

struct SmallFile {
  std::string content;
  bool others_may_read = false;
};

// A pipe or a device could let the start wait for ever.
SmallFile ReadSmallFile(const std::string& origin, const std::string& file) {
  const auto refuse = [&](const std::string& reason) -> SmallFile {
    throw UsageError(
        fmt::format("{}: cannot read a token: {}; expected a file with the token in its first line",
                    origin, reason));
  };
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return refuse(std::strerror(errno));
  std::string content(kMaxFileBytes + 1, '\0');
  struct stat status {};
  const bool is_file = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const ssize_t count = is_file ? ::read(descriptor, content.data(), content.size()) : 0;
  const int reason = errno;
  ::close(descriptor);
  if (!is_file) return refuse("it is a folder, a pipe or a device");
  if (count < 0) return refuse(std::strerror(reason));
  if (status.st_size > kMaxFileBytes || count > kMaxFileBytes) {
    return refuse(fmt::format("{} bytes are more than {}", status.st_size, kMaxFileBytes));
  }
  content.resize(static_cast<std::size_t>(count));
  return {std::move(content), (status.st_mode & (S_IRGRP | S_IROTH)) != 0};
}

PageToken FromFile(const TokenNames& names, const std::string& file) {
  PageToken token;
  token.origin = fmt::format("--{}_file={}", names.option, file);
  token.how_to_see = "cat " + file;
  if (MakeTokenFile(token.origin, file)) {
    token.notes.push_back(fmt::format("{}: made with a random token", token.origin));
  }
  const SmallFile found = ReadSmallFile(token.origin, file);
  token.text = found.content.substr(0, found.content.find('\n'));
  while (!token.text.empty() && std::strchr(" \t\r", token.text.back()) != nullptr) {
    token.text.pop_back();
  }
  if (token.text.empty()) {
    throw UsageError(
        fmt::format("{}: the first line is empty, expected a token; delete the file to "
                    "have a random one made",
                    token.origin));
  }
  if (found.others_may_read) {
    token.notes.push_back(
        fmt::format("{}: other users of this machine can read the token; run "
                    "chmod 600 {}",
                    token.origin, file));
  }
  return token;
}

// Who may see the token at `origin`, for the log; "": not known.
std::string WhoSees(const TokenNames& names, const std::string& origin) {
  const std::string option = names.option;
  const char* const who = origin == "--" + option
                              ? "every user of this machine, in the list of processes,"
                          : origin == "~" + option ? "everyone who reaches the ROS master"
                                                   : nullptr;
  if (who == nullptr) return "";
  return fmt::format("{}: {} can see the token; prefer --{}_file or the environment variable {}",
                     origin, who, option, names.variable);
}

}  // namespace

PageToken FindPageToken(const TokenNames& names, const TokenOption& option, const std::string& file,
                        const char* variable) {
  const std::string origin =
      option.origin.empty() ? fmt::format("--{}", names.option) : option.origin;
  if (!option.text.empty() && !file.empty()) {
    throw UsageError(fmt::format("{} and --{}_file set the same token; remove {}", origin,
                                 names.option, origin));
  }
  if (!file.empty()) return FromFile(names, file);
  PageToken token;
  if (!option.text.empty()) {
    token.text = option.text;
    token.origin = origin;
    const std::string note = WhoSees(names, origin);
    if (!note.empty()) token.notes.push_back(note);
  } else if (variable != nullptr && *variable != '\0') {
    token.text = variable;
    token.origin = names.variable;
    token.how_to_see = std::string("echo $") + names.variable;
  }
  return token;
}

void CheckTokenIsGiven(const std::string& given_as, const std::string& value) {
  if (given_as.empty() || given_as.front() == '~' || !value.empty()) return;
  throw UsageError(fmt::format(
      "{}=: empty, so the page would have no token; set a value or remove this option", given_as));
}

}  // namespace kinescope::app
