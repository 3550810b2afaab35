#include "server/http/tls_certificate.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::http {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;
using SystemClock = std::chrono::system_clock;

constexpr std::size_t kMaxPemBytes = 1 << 20;
constexpr std::chrono::hours kSoon{14 * 24};

template <class T, void (*kFree)(T*)>
struct Freeing {
  void operator()(T* object) const { kFree(object); }
};
using X509Ptr = std::unique_ptr<X509, Freeing<X509, X509_free>>;
using NamesPtr = std::unique_ptr<GENERAL_NAMES, Freeing<GENERAL_NAMES, GENERAL_NAMES_free>>;

std::string ReadPem(const char* option, const std::filesystem::path& path) {
  const std::string what = std::string(option) + "=" + path.string() + ": ";
  if (std::filesystem::is_directory(path)) throw UsageError(what + "a folder; name the PEM file");
  std::string text(kMaxPemBytes + 1, '\0');
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())) && file.gcount() == 0) {
    const std::string reason = file.is_open() ? "the file is empty" : std::strerror(errno);
    throw UsageError(what + "cannot be read: " + reason +
                     "; name a PEM file that this user may read");
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxPemBytes) throw UsageError(what + "larger than 1 MiB, so no PEM file");
  return text;
}

bool Holds(const std::string& pem, const char* what) { return pem.find(what) != std::string::npos; }

[[noreturn]] void RefuseCertificate(const TlsFiles& files, const std::string& reason) {
  throw UsageError("--tls_certificate=" + files.certificate.string() + ": " + reason);
}

[[noreturn]] void RefuseKey(const TlsFiles& files, const std::string& reason) {
  throw UsageError("--tls_key=" + files.key.string() + ": " + reason);
}

void CheckText(const TlsFiles& files, const std::string& chain, const std::string& key) {
  if (!Holds(chain, "-----BEGIN CERTIFICATE-----")) {
    RefuseCertificate(files,
                      "no certificate in it; expected PEM, which has the line -----BEGIN "
                      "CERTIFICATE-----. Convert DER with openssl x509 -inform der");
  }
  if (!Holds(key, "PRIVATE KEY-----")) {
    RefuseKey(files,
              "no private key in it; expected PEM, which has a line -----BEGIN PRIVATE KEY-----");
  }
  if (Holds(key, "ENCRYPTED")) {
    RefuseKey(
        files,
        "the key has a passphrase, which a server cannot be asked for; remove it with openssl "
        "pkey -in FILE -out NEW_FILE");
  }
}

std::string TextOf(const ASN1_STRING* string) {
  if (string == nullptr) return "";
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(string)),
          static_cast<std::size_t>(ASN1_STRING_length(string))};
}

std::string AddressText(const ASN1_OCTET_STRING* bytes) {
  const std::string raw = TextOf(bytes);
  std::string text;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    std::array<char, 8> part{};
    const auto byte = static_cast<unsigned>(static_cast<unsigned char>(raw[i]));
    if (raw.size() == 4) {
      std::snprintf(part.data(), part.size(), i > 0 ? ".%u" : "%u", byte);
    } else {
      std::snprintf(part.data(), part.size(), i > 0 && i % 2 == 0 ? ":%02x" : "%02x", byte);
    }
    text += part.data();
  }
  return text;
}

// Names are from a file of the operator's, but a log has one line for each message.
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return text;
}

std::string NamesOf(X509* certificate) {
  std::string names;
  const NamesPtr all(static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; all != nullptr && i < sk_GENERAL_NAME_num(all.get()); ++i) {
    const GENERAL_NAME* const name = sk_GENERAL_NAME_value(all.get(), i);
    std::string text;
    if (name->type == GEN_DNS) text = TextOf(name->d.dNSName);
    if (name->type == GEN_IPADD) text = AddressText(name->d.iPAddress);
    if (!text.empty()) names += (names.empty() ? "" : ", ") + text;
  }
  return names.empty() ? "no name" : OneLine(names);
}

SystemClock::time_point EndOf(X509* certificate) {
  std::tm end{};
  ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end);
  return SystemClock::from_time_t(::timegm(&end));
}

std::string UtcText(SystemClock::time_point time) {
  const std::time_t seconds = SystemClock::to_time_t(time);
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
  return text.data();
}

std::shared_ptr<ssl::context> MakeContext(const TlsFiles& files) {
  const std::string chain = ReadPem("--tls_certificate", files.certificate);
  const std::string key = ReadPem("--tls_key", files.key);
  CheckText(files, chain, key);
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX* const native = context->native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
  SSL_CTX_set_options(
      native, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
  error_code error;
  context->use_certificate_chain(boost::asio::buffer(chain), error);
  if (error) RefuseCertificate(files, "damaged, or not for servers: " + error.message());
  // Without this, OpenSSL would ask for a passphrase on the terminal.
  context->set_password_callback([](std::size_t, ssl::context::password_purpose) { return ""; });
  context->use_private_key(boost::asio::buffer(key), ssl::context::pem, error);
  if (error &&
      ERR_GET_REASON(static_cast<unsigned long>(error.value())) == X509_R_KEY_VALUES_MISMATCH) {
    RefuseKey(files, "not the key of the certificate " + files.certificate.string() +
                         "; name the one with which it was requested");
  }
  if (error) RefuseKey(files, "damaged: " + error.message());
  return context;
}

}  // namespace

TlsCertificate::TlsCertificate(TlsFiles files, std::function<void(const std::string&)> log)
    : files_(std::move(files)), log_(std::move(log)) {
  if (files_.certificate.empty() || files_.key.empty()) {
    throw UsageError(files_.key.empty()
                         ? "--tls_certificate: needs its private key; set --tls_key=FILE, too"
                         : "--tls_key: needs its certificate; set --tls_certificate=FILE, too");
  }
  tried_ = StampsOfFiles();
  Load();
}

void TlsCertificate::Load() {
  context_ = MakeContext(files_);
  X509* const certificate = SSL_CTX_get0_certificate(context_->native_handle());
  const auto end = EndOf(certificate);
  status_.names = NamesOf(certificate);
  status_.valid_until = UtcText(end);
  status_.last_error.clear();
  WarnOfEnd(end);
}

void TlsCertificate::WarnOfEnd(SystemClock::time_point end) const {
  const auto now = SystemClock::now();
  if (!log_ || end - now > kSoon) return;
  log_("--tls_certificate=" + files_.certificate.string() + ": the certificate of " +
       status_.names + (end < now ? " has ended at " : " ends at ") + status_.valid_until +
       "; browsers refuse it then. A new file is used without a restart");
}

TlsCertificate::Stamps TlsCertificate::StampsOfFiles() const {
  Stamps stamps;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    struct stat facts {};
    if (::stat((i == 0 ? files_.certificate : files_.key).c_str(), &facts) != 0) continue;
    stamps[i] = {facts.st_mtim.tv_sec * 1'000'000'000 + facts.st_mtim.tv_nsec,
                 static_cast<std::int64_t>(facts.st_size), static_cast<std::int64_t>(facts.st_ino)};
  }
  return stamps;
}

void TlsCertificate::Check(std::chrono::steady_clock::time_point now) {
  if (now < next_check_) return;
  next_check_ = now + kCheckInterval;
  const Stamps stamps = StampsOfFiles();
  if (stamps == tried_) {
    changed_.reset();
    return;
  }
  if (!changed_ || !(*changed_ == stamps)) {  // it may still be written
    changed_ = stamps;
    return;
  }
  changed_.reset();
  tried_ = stamps;
  try {
    Load();
    ++status_.reloads;
    if (log_)
      log_("the new certificate of " + status_.names + " is in use, until " + status_.valid_until);
  } catch (const std::exception& failure) {
    ++status_.failed_reloads;
    status_.last_error = failure.what();
    if (log_) log_(std::string(failure.what()) + ". The certificate from before stays in use");
  }
}

}  // namespace kinescope::http
