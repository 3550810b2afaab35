#include "server/download/web_file.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "core/system/check.h"

namespace kinescope::download {
namespace {

constexpr long kMostRedirections = 5;
constexpr char kProtocols[] = "http,https";

std::string WithoutQuery(const std::string& address) {
  return address.substr(0, address.find_first_of("?#"));
}

}  // namespace

std::string FileNameOf(const std::string& address) {
  const std::string path = WithoutQuery(address);
  const std::size_t begin = path.find("://") == std::string::npos ? 0 : path.find("://") + 3;
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos || slash < begin ? "" : path.substr(slash + 1);
}

struct WebLoader::Transfer {
  CURL* curl = nullptr;
  std::ofstream file;
  std::size_t bytes = 0, most_bytes = 0;
  bool is_too_large = false;

  Transfer() {
    static const CURLcode kReady = curl_global_init(CURL_GLOBAL_DEFAULT);
    KINESCOPE_CHECK(kReady == CURLE_OK);
    curl = curl_easy_init();
    KINESCOPE_CHECK(curl != nullptr);
  }
  ~Transfer() { curl_easy_cleanup(curl); }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  // Not all bytes taken: the transfer ends.
  static std::size_t Take(char* data, std::size_t size, std::size_t count, void* transfer) {
    auto& self = *static_cast<Transfer*>(transfer);
    const std::size_t bytes = size * count;
    self.is_too_large = bytes > self.most_bytes - self.bytes;
    if (self.is_too_large) return 0;
    self.bytes += bytes;
    self.file.write(data, static_cast<std::streamsize>(bytes));
    return self.file ? bytes : 0;
  }

  // Not 0: the transfer ends.
  static int EndIfStopped(void* stopped, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    const auto& is_stopped = *static_cast<const std::function<bool()>*>(stopped);
    return is_stopped && is_stopped() ? 1 : 0;
  }
};

WebLoader::WebLoader(const WebLimits& limits, std::function<bool()> is_stopped)
    : limits_(limits), is_stopped_(std::move(is_stopped)), transfer_(std::make_unique<Transfer>()) {
  CURL* const curl = transfer_->curl;
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, kProtocols);
  curl_easy_setopt(curl, CURLOPT_REDIR_PROTOCOLS_STR, kProtocols);
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(curl, CURLOPT_MAXREDIRS, kMostRedirections);
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(limits.connect_secs * 1000));
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(limits.secs * 1000));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);  // signals belong to the program
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, Transfer::Take);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, transfer_.get());
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, Transfer::EndIfStopped);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &is_stopped_);
}

WebLoader::~WebLoader() = default;

WebLoader::Outcome WebLoader::Load(const std::string& address, const std::filesystem::path& into) {
  Transfer& transfer = *transfer_;
  transfer.file.open(into, std::ios::binary | std::ios::trunc);
  transfer.bytes = 0;
  transfer.most_bytes = limits_.most_bytes;
  transfer.is_too_large = false;
  Outcome outcome;
  if (!transfer.file) {
    outcome.problem = into.string() + ": cannot write this file";
    return outcome;
  }
  curl_easy_setopt(transfer.curl, CURLOPT_URL, address.c_str());
  const CURLcode result = curl_easy_perform(transfer.curl);
  transfer.file.close();
  long status = 0;
  curl_easy_getinfo(transfer.curl, CURLINFO_RESPONSE_CODE, &status);
  outcome.bytes = transfer.bytes;
  if (transfer.is_too_large) {
    outcome.problem = fmt::format("it has more than {} bytes", limits_.most_bytes);
  } else if (result != CURLE_OK) {
    outcome.problem = curl_easy_strerror(result);
    outcome.is_of_server = result == CURLE_OPERATION_TIMEDOUT || result == CURLE_COULDNT_CONNECT ||
                           result == CURLE_COULDNT_RESOLVE_HOST ||
                           result == CURLE_ABORTED_BY_CALLBACK;
  } else if (status != 200) {
    outcome.problem = fmt::format("its server answered with status {}", status);
  } else if (!transfer.file) {
    outcome.problem = into.string() + ": cannot write this file";
  }
  if (outcome.problem.empty()) return outcome;
  std::error_code ignored;
  std::filesystem::remove(into, ignored);
  return outcome;
}

}  // namespace kinescope::download
