#include "server/ros/xmlrpc_limits.h"

#include <spdlog/spdlog.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcServerConnection.h>
#include <xmlrpcpp/XmlRpcSocket.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/starts_with.h"
#include "server/ros/master_answers.h"
#include "server/ros/original_function.h"

namespace kinescope::ros_bridge {
namespace {

constexpr char kXmlRpcTooDeep[] = "values nested deeper than 32 levels";
constexpr char kXmlRpcNotWellFormed[] = "a value that is not well-formed";
constexpr char kXmlRpcTooLong[] = "more than 4 MiB";
constexpr char kXmlRpcHeaderTooLong[] = "an HTTP header of more than 64 KiB";
constexpr char kXmlRpcMulticall[] = "system.multicall, which can call itself without end";

constexpr std::size_t kMostXmlRpcAtOnce = 64 * 1024;  // bytes read before the text is looked at

// The values of XML-RPC as Python and XmlRpc++ write them, which is stricter than what XmlRpc++
// reads: it searches for a missing end tag in the rest of the text, again and again.
class ValueScanner {
 public:
  ValueScanner(std::string_view text, std::size_t offset)
      : rest_(text.substr(std::min(offset, text.size()))) {}

  const char* Scan() {
    if (Value(1)) return nullptr;
    return is_too_deep_ ? kXmlRpcTooDeep : kXmlRpcNotWellFormed;
  }

 private:
  static constexpr std::string_view kSpace = " \t\r\n";
  static bool IsSpace(std::string_view text) {
    return text.find_first_not_of(kSpace) == std::string_view::npos;
  }
  void SkipSpace() { rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpace), rest_.size())); }
  bool Take(std::string_view tag) {
    if (!StartsWith(rest_, tag)) return false;
    rest_.remove_prefix(tag.size());
    return true;
  }
  bool TakeAfterSpace(std::string_view tag) {
    SkipSpace();
    return Take(tag);
  }
  // Text up to the next tag.
  bool Text() {
    const std::size_t end = rest_.find('<');
    if (end == std::string_view::npos) return false;
    rest_.remove_prefix(end);
    return true;
  }

  bool Value(int depth) {
    is_too_deep_ = is_too_deep_ || depth > kDeepestXmlRpcValue;
    if (is_too_deep_ || !TakeAfterSpace("<value>")) return false;
    const std::string_view before = rest_;
    if (!Text()) return false;
    if (Take("</value>")) return true;  // a string
    const std::string_view text = before.substr(0, before.size() - rest_.size());
    return IsSpace(text) && Typed(depth) && TakeAfterSpace("</value>");
  }

  bool Typed(int depth) {
    if (Take("<array>")) return Array(depth);
    if (Take("<struct>")) return Struct(depth);
    const std::size_t end = rest_.find('>');
    if (end == std::string_view::npos || end < 2 || rest_[1] == '/') return false;
    const std::string_view name = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    if (name.back() == '/') return true;
    return Text() && Take("</") && Take(name) && Take(">");
  }

  bool Array(int depth) {
    if (!TakeAfterSpace("<data>")) return false;
    while (!TakeAfterSpace("</data>")) {
      if (!Value(depth + 1)) return false;
    }
    return TakeAfterSpace("</array>");
  }

  bool Struct(int depth) {
    while (TakeAfterSpace("<member>")) {
      const bool has_name = TakeAfterSpace("<name>") && Text() && Take("</name>");
      if (!has_name || !Value(depth + 1) || !TakeAfterSpace("</member>")) return false;
    }
    return Take("</struct>");
  }

  std::string_view rest_;
  bool is_too_deep_ = false;
};

struct Rejections {
  std::mutex mutex;
  std::map<std::string, std::uint64_t> by_reason;  // guarded by mutex
};

Rejections& AllRejections() {
  static Rejections rejections;
  return rejections;
}

thread_local std::string problem_of_thread;

// Number of values that XmlRpc++ is inside of, on this thread.
class ValueDepth {
 public:
  ValueDepth() { ++depth_; }
  ~ValueDepth() { --depth_; }
  ValueDepth(const ValueDepth&) = delete;
  ValueDepth& operator=(const ValueDepth&) = delete;
  int now() const { return depth_; }

 private:
  static inline thread_local int depth_ = 0;
};

std::atomic<std::int64_t> call_timeout_millis{-1};  // < 0: no limit
std::atomic<std::int64_t> last_calls_end_nanos{0};  // monotonic; 0: no limit

// `warning` is logged once per reason: any host can cause it as often as it likes.
void Reject(const std::string& reason, const std::string& warning) {
  problem_of_thread = reason;
  if (CountRejection(reason) == 1) spdlog::warn("{}", warning);
}

void RejectXmlRpc(const std::string& reason) {
  Reject(reason, "XML-RPC of a ROS master or node was rejected: " + reason);
}

// The method that the client has called.
std::string_view MethodOf(std::string_view request) {
  constexpr std::string_view kBegin = "<methodName>";
  const std::size_t begin = request.find(kBegin);
  if (begin == std::string_view::npos) return "";
  request.remove_prefix(begin + kBegin.size());
  return request.substr(0, request.find('<'));
}

// As the master answers a call that has failed.
XmlRpc::XmlRpcValue FailedCall(const std::string& reason) {
  XmlRpc::XmlRpcValue answer;
  answer[0] = 0;
  answer[1] = reason;
  answer[2] = 0;
  return answer;
}

// Whether to read on: `header` has come so far, then the text follows.
bool IsHeaderAccepted(const std::string& header, bool is_complete, int content_length) {
  const char* reason = nullptr;
  if (!is_complete && header.size() > kLargestXmlRpcHeader) reason = kXmlRpcHeaderTooLong;
  if (is_complete && content_length > static_cast<int>(kLargestXmlRpcText)) {
    reason = kXmlRpcTooLong;
  }
  if (reason != nullptr) RejectXmlRpc(reason);
  return reason == nullptr;
}

}  // namespace

const char* DefectOfXmlRpcValue(std::string_view text, std::size_t offset) {
  return ValueScanner(text, offset).Scan();
}

void LimitXmlRpcCalls(std::chrono::milliseconds timeout) { call_timeout_millis = timeout.count(); }

void LimitLastXmlRpcCalls(std::chrono::milliseconds total) {
  if (total.count() < 0) {
    last_calls_end_nanos = 0;
    return;
  }
  std::int64_t none = 0;
  last_calls_end_nanos.compare_exchange_strong(
      none, MonotonicNanos() + std::chrono::nanoseconds(total).count());
}

std::chrono::milliseconds XmlRpcTimeLeft(std::chrono::milliseconds timeout) {
  const std::int64_t end = last_calls_end_nanos;
  if (end == 0) return timeout;
  const std::chrono::milliseconds rest(
      std::max<std::int64_t>(0, (end - MonotonicNanos()) / 1'000'000));
  return timeout.count() < 0 ? rest : std::min(timeout, rest);
}

std::uint64_t CountRejection(const std::string& reason) {
  Rejections& rejections = AllRejections();
  const std::lock_guard<std::mutex> lock(rejections.mutex);
  return ++rejections.by_reason[reason];
}

std::string TakeXmlRpcProblem() { return std::exchange(problem_of_thread, ""); }

std::map<std::string, std::uint64_t> RejectedXmlRpc() {
  Rejections& rejections = AllRejections();
  const std::lock_guard<std::mutex> lock(rejections.mutex);
  return rejections.by_reason;
}

}  // namespace kinescope::ros_bridge

namespace XmlRpc {

namespace limits = kinescope::ros_bridge;

bool XmlRpcValue::fromXml(const std::string& text, int* offset) {
  static const auto original = limits::Original<bool (*)(XmlRpcValue*, const std::string&, int*)>(
      "_ZN6XmlRpc11XmlRpcValue7fromXmlERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEPi");
  const limits::ValueDepth depth;
  if (offset == nullptr || *offset < 0 || depth.now() > limits::kDeepestXmlRpcValue) return false;
  if (depth.now() == 1) {  // what is nested in it is scanned, too
    const char* const defect = limits::DefectOfXmlRpcValue(text, static_cast<std::size_t>(*offset));
    if (defect != nullptr) {
      limits::RejectXmlRpc(defect);
      return false;
    }
  }
  return original(this, text, offset);
}

bool XmlRpcSocket::nbRead(int socket, std::string& text, bool* eof) {
  std::array<char, 4096> block;
  *eof = false;
  for (std::size_t taken = 0; taken < limits::kMostXmlRpcAtOnce;) {  // the rest at the next event
    const ssize_t count = read(socket, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINPROGRESS;
    if (count == 0) {
      *eof = true;
      return true;
    }
    taken += static_cast<std::size_t>(count);
    text.append(block.data(), static_cast<std::size_t>(count));
  }
  return true;
}

bool XmlRpcClient::readHeader() {
  static const auto original =
      limits::Original<bool (*)(XmlRpcClient*)>("_ZN6XmlRpc12XmlRpcClient10readHeaderEv");
  return original(this) &&
         limits::IsHeaderAccepted(_header, _connectionState == READ_RESPONSE, _contentLength);
}

// An answer that the method cannot have becomes that of a call that has failed, which roscpp
// expects everywhere.
bool XmlRpcClient::parseResponse(XmlRpcValue& result) {
  static const auto original = limits::Original<bool (*)(XmlRpcClient*, XmlRpcValue&)>(
      "_ZN6XmlRpc12XmlRpcClient13parseResponseERNS_11XmlRpcValueE");
  if (!original(this, result)) return false;
  if (_isFault) return true;  // roscpp takes it for a failed call
  const std::string defect = limits::DefectOfAnswer(limits::MethodOf(_request), result);
  if (defect.empty()) return true;
  limits::Reject(defect, "the ROS master or node at " + _host + ":" + std::to_string(_port) + " " +
                             defect + "; the call counts as failed");
  result = limits::FailedCall(defect);
  return true;
}

bool XmlRpcServerConnection::readHeader() {
  static const auto original = limits::Original<bool (*)(XmlRpcServerConnection*)>(
      "_ZN6XmlRpc22XmlRpcServerConnection10readHeaderEv");
  return original(this) &&
         limits::IsHeaderAccepted(_header, _connectionState == READ_REQUEST, _contentLength);
}

bool XmlRpcServerConnection::executeMethod(const std::string& method, XmlRpcValue& arguments,
                                           XmlRpcValue& result) {
  static const auto original = limits::Original<bool (*)(
      XmlRpcServerConnection*, const std::string&, XmlRpcValue&, XmlRpcValue&)>(
      "_ZN6XmlRpc22XmlRpcServerConnection13executeMethodERKNSt7__cxx1112basic_stringIcSt11char_"
      "traitsIcESaIcEEERNS_11XmlRpcValueESA_");
  const std::string defect = limits::DefectOfRequest(method, arguments);
  if (defect.empty()) return original(this, method, arguments, result);
  limits::RejectXmlRpc(defect);
  return false;  // an unknown method
}

// Nodes do not need it, and one inside another calls itself until the stack is used up.
bool XmlRpcServerConnection::executeMulticall(const std::string& method, XmlRpcValue&,
                                              XmlRpcValue&) {
  if (method == SYSTEM_MULTICALL) limits::RejectXmlRpc(limits::kXmlRpcMulticall);
  return false;  // an unknown method
}

void XmlRpcDispatch::work(double timeout) {
  static const auto original =
      limits::Original<void (*)(XmlRpcDispatch*, double)>("_ZN6XmlRpc14XmlRpcDispatch4workEd");
  if (timeout >= 0) return original(this, timeout);  // one that Kinescope has chosen
  const auto left = limits::XmlRpcTimeLeft(std::chrono::milliseconds(limits::call_timeout_millis));
  original(this, left.count() < 0 ? timeout : std::chrono::duration<double>(left).count());
}

}  // namespace XmlRpc
