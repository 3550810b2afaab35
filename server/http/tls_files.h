/// The files of a server with TLS, and what became of them. Plain values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kinescope::http {

/// Both are set, or none: then the server does not encrypt.
struct TlsFiles {
  std::filesystem::path certificate;  // PEM; with its chain, the server's own first
  std::filesystem::path key;          // PEM, without a passphrase

  bool any() const { return !certificate.empty() || !key.empty(); }
};

/// For /api/v1/diagnostics.
struct TlsStatus {
  std::string names;        // of the certificate: "lab.example, 192.168.1.20"
  std::string valid_until;  // "2027-01-31 12:00:00 UTC"
  std::uint64_t reloads = 0;
  std::uint64_t failed_reloads = 0;
  std::string last_error;  // "" after a successful one
};

}  // namespace kinescope::http
