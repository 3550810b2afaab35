/// The certificate of the server with its private key, from two PEM files. When these change, they
/// are read again: new connections then use the new ones, and open ones go on with theirs. A file
/// that cannot be used is reported and changes nothing. TLS 1.2 and later. Time is an argument. One
/// thread. Nothing of a key is ever in a message.
#pragma once

#include <array>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/tls_files.h"

namespace kinescope::http {

class TlsCertificate {
 public:
  using Context = boost::asio::ssl::context;
  static constexpr std::chrono::seconds kCheckInterval{2};

  /// `log` receives lines about changes and about a certificate that is about to end.
  /// @throws UsageError with the option, the file, the reason and the way out.
  TlsCertificate(TlsFiles files, std::function<void(const std::string&)> log);

  /// For new connections; those that have one keep it alive.
  const std::shared_ptr<Context>& context() const { return context_; }
  const TlsStatus& status() const { return status_; }

  /// Reads the files again if they have changed and stayed so for a kCheckInterval: certificate and
  /// key are rarely replaced at the same instant. Call it now and then.
  void Check(std::chrono::steady_clock::time_point now);

 private:
  struct Stamp {  // of a file; all zero if it is missing
    std::int64_t modified_nanos = 0, size = 0, inode = 0;
    bool operator==(const Stamp& other) const {
      return modified_nanos == other.modified_nanos && size == other.size && inode == other.inode;
    }
  };
  using Stamps = std::array<Stamp, 2>;
  [[nodiscard]] Stamps StampsOfFiles() const;
  void Load();
  void WarnOfEnd(std::chrono::system_clock::time_point end) const;

  const TlsFiles files_;
  const std::function<void(const std::string&)> log_;
  std::shared_ptr<Context> context_;
  TlsStatus status_;
  Stamps tried_;  // of what was loaded last, or could not be
  std::optional<Stamps> changed_;
  std::chrono::steady_clock::time_point next_check_{};
};

}  // namespace kinescope::http
