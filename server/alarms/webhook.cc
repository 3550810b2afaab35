#include "server/alarms/webhook.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <utility>

#include "core/system/check.h"
#include "core/system/web_address.h"

namespace kinescope::alarms {
namespace {

struct FreeHandle {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

std::size_t IgnoreBody(char* /*data*/, std::size_t size, std::size_t count, void* /*user*/) {
  return size * count;
}

// Not 0: the transfer ends.
int EndsIfStopped(void* stopped, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return (*static_cast<std::function<bool()>*>(stopped))() ? 1 : 0;
}

}  // namespace

Webhook::Webhook(Settings settings) : settings_(std::move(settings)) {
  static const CURLcode kReady = curl_global_init(CURL_GLOBAL_DEFAULT);
  KINESCOPE_CHECK(kReady == CURLE_OK);
  thread_ = std::thread([this] { Run(); });
}

Webhook::~Webhook() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Webhook::Send(std::string body) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++counters_.dropped;
      return;
    }
    waiting_.push_back(std::move(body));
  }
  changed_.notify_all();
}

WebhookCounters Webhook::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

void Webhook::Run() {
  while (true) {
    std::string body;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stops_ || !waiting_.empty(); });
      if (stops_) return;
      body = std::move(waiting_.front());
      waiting_.pop_front();
    }
    Deliver(body);
  }
}

void Webhook::Deliver(const std::string& body) {
  std::string error;
  for (int i = 0; i < settings_.tries; ++i) {
    if (i > 0 && !Pause()) return;
    error = Post(body);
    if (error.empty()) break;
  }
  Note(error);
}

bool Webhook::Pause() {
  std::unique_lock<std::mutex> lock(mutex_);
  return !changed_.wait_for(lock, std::chrono::duration<double>(settings_.pause_secs),
                            [this] { return stops_; });
}

void Webhook::Note(const std::string& error) {
  bool is_news = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stops_) return;
    ++(error.empty() ? counters_.delivered : counters_.failed);
    is_news = error.empty() != counters_.last_error.empty();
    counters_.last_error = error;
  }
  if (!is_news || !settings_.warn) return;
  const std::string host = ServerOf(settings_.url);
  settings_.warn(error.empty() ? fmt::format("alarms: {} hears of them again", host)
                               : fmt::format("alarms: {} could not be told: {}", host, error));
}

std::string Webhook::Post(const std::string& body) {
  const std::unique_ptr<CURL, FreeHandle> handle(curl_easy_init());
  if (handle == nullptr) return "no memory";
  const std::unique_ptr<curl_slist, FreeList> headers(
      curl_slist_append(nullptr, "Content-Type: application/json"));
  std::function<bool()> stopped = [this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stops_;
  };
  CURL* const curl = handle.get();
  curl_easy_setopt(curl, CURLOPT_URL, settings_.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.c_str());
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(settings_.timeout_secs * 1000));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);  // signals belong to the program
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, IgnoreBody);
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, EndsIfStopped);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &stopped);
  const CURLcode result = curl_easy_perform(curl);
  if (result != CURLE_OK) return curl_easy_strerror(result);
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  if (status >= 200 && status < 300) return "";
  return fmt::format("it answered with status {}", status);
}

}  // namespace kinescope::alarms
