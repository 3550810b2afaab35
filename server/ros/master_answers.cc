#include "server/ros/master_answers.h"

#include <algorithm>
#include <array>

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

enum class AnswerType { kAny, kInt, kBoolean, kString, kArray, kStrings, kPublishers, kPairs };

struct MethodAnswer {
  std::string_view method;
  AnswerType type;  // of the value if the call was successful
};

// kAny: a parameter, or a value that neither roscpp nor Kinescope uses.
constexpr std::array kMethodAnswers = {
    MethodAnswer{"deleteParam", AnswerType::kAny},
    MethodAnswer{"getBusInfo", AnswerType::kArray},
    MethodAnswer{"getParam", AnswerType::kAny},
    MethodAnswer{"getParamNames", AnswerType::kStrings},
    MethodAnswer{"getPid", AnswerType::kInt},
    MethodAnswer{"getPublishedTopics", AnswerType::kPairs},
    MethodAnswer{"getSystemState", AnswerType::kArray},
    MethodAnswer{"getTopicTypes", AnswerType::kPairs},
    MethodAnswer{"getUri", AnswerType::kString},
    MethodAnswer{"hasParam", AnswerType::kBoolean},
    MethodAnswer{"kinescope_time", AnswerType::kStrings},
    MethodAnswer{"lookupNode", AnswerType::kString},
    MethodAnswer{"lookupService", AnswerType::kString},
    MethodAnswer{"publisherUpdate", AnswerType::kAny},
    MethodAnswer{"registerPublisher", AnswerType::kAny},
    MethodAnswer{"registerService", AnswerType::kAny},
    MethodAnswer{"registerSubscriber", AnswerType::kPublishers},
    MethodAnswer{"requestTopic", AnswerType::kArray},
    MethodAnswer{"searchParam", AnswerType::kString},
    MethodAnswer{"setParam", AnswerType::kAny},
    MethodAnswer{"subscribeParam", AnswerType::kAny},
    MethodAnswer{"unregisterPublisher", AnswerType::kAny},
    MethodAnswer{"unregisterService", AnswerType::kAny},
    MethodAnswer{"unregisterSubscriber", AnswerType::kAny},
    MethodAnswer{"unsubscribeParam", AnswerType::kAny},
};

bool IsOf(const XmlRpcValue& value, XmlRpcValue::Type type) { return value.getType() == type; }

bool AreStrings(const XmlRpcValue& list) {
  if (!IsOf(list, XmlRpcValue::TypeArray)) return false;
  for (int i = 0; i < list.size(); ++i) {
    if (!IsOf(list[i], XmlRpcValue::TypeString)) return false;
  }
  return true;
}

bool ArePairs(const XmlRpcValue& list) {
  if (!IsOf(list, XmlRpcValue::TypeArray)) return false;
  for (int i = 0; i < list.size(); ++i) {
    if (!AreStrings(list[i]) || list[i].size() != 2) return false;
  }
  return true;
}

bool HasAnswerType(const XmlRpcValue& value, AnswerType type) {
  switch (type) {
    case AnswerType::kAny: return value.valid();
    case AnswerType::kInt: return IsOf(value, XmlRpcValue::TypeInt);
    case AnswerType::kBoolean: return IsOf(value, XmlRpcValue::TypeBoolean);
    case AnswerType::kString: return IsOf(value, XmlRpcValue::TypeString);
    case AnswerType::kArray: return IsOf(value, XmlRpcValue::TypeArray);
    case AnswerType::kStrings:
    case AnswerType::kPublishers: return AreStrings(value);
    case AnswerType::kPairs: return ArePairs(value);
  }
  return false;
}

const char* NameOf(AnswerType type) {
  switch (type) {
    case AnswerType::kAny: return "a value";
    case AnswerType::kInt: return "an int";
    case AnswerType::kBoolean: return "a boolean";
    case AnswerType::kString: return "a string";
    case AnswerType::kArray: return "an array";
    case AnswerType::kStrings:
    case AnswerType::kPublishers: return "an array of strings";
    case AnswerType::kPairs: return "an array of pairs of strings";
  }
  return "";
}

std::string TooManyPublishers() {
  return "more than " + std::to_string(kMostPublishers) + " publishers of a topic";
}

}  // namespace

std::string TypeNameOf(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean: return "a boolean";
    case XmlRpcValue::TypeInt: return "an int";
    case XmlRpcValue::TypeDouble: return "a double";
    case XmlRpcValue::TypeString: return "a string";
    case XmlRpcValue::TypeDateTime: return "a date";
    case XmlRpcValue::TypeBase64: return "binary data";
    case XmlRpcValue::TypeArray: return "an array";
    case XmlRpcValue::TypeStruct: return "a struct";
    case XmlRpcValue::TypeInvalid: break;
  }
  return "no value";
}

std::string DefectOfAnswer(std::string_view method, const XmlRpcValue& answer) {
  const auto* const known =
      std::find_if(kMethodAnswers.begin(), kMethodAnswers.end(),
                   [&](const MethodAnswer& entry) { return entry.method == method; });
  if (known == kMethodAnswers.end()) return "";
  const std::string answered = "answered " + std::string(method) + " with ";
  const std::string expected = " instead of [status, message, value]";
  if (!IsOf(answer, XmlRpcValue::TypeArray)) return answered + TypeNameOf(answer) + expected;
  if (answer.size() != 3) return answered + std::to_string(answer.size()) + " values" + expected;
  if (!IsOf(answer[0], XmlRpcValue::TypeInt)) {
    return answered + TypeNameOf(answer[0]) + " as its status instead of an int";
  }
  if (!IsOf(answer[1], XmlRpcValue::TypeString)) {
    return answered + TypeNameOf(answer[1]) + " as its message instead of a string";
  }
  XmlRpcValue status = answer[0];
  if (static_cast<int>(status) != 1) return "";  // an error: its value has no meaning
  const XmlRpcValue& value = answer[2];
  if (!HasAnswerType(value, known->type)) {
    const bool is_array = IsOf(value, XmlRpcValue::TypeArray);
    return answered + (is_array ? "an array of other values" : TypeNameOf(value)) + " instead of " +
           NameOf(known->type);
  }
  if (known->type == AnswerType::kPublishers && value.size() > kMostPublishers) {
    return answered + TooManyPublishers();
  }
  return "";
}

std::string DefectOfRequest(std::string_view method, const XmlRpcValue& arguments) {
  if (method != "publisherUpdate") return "";
  const bool is_sound = IsOf(arguments, XmlRpcValue::TypeArray) && arguments.size() == 3 &&
                        IsOf(arguments[0], XmlRpcValue::TypeString) &&
                        IsOf(arguments[1], XmlRpcValue::TypeString) && AreStrings(arguments[2]);
  if (!is_sound) return "publisherUpdate with invalid arguments";
  return arguments[2].size() > kMostPublishers ? "publisherUpdate with " + TooManyPublishers() : "";
}

}  // namespace kinescope::ros_bridge
