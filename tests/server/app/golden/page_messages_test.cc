#include "server/app/golden/page_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace kinescope::app {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Action>
std::string ErrorOfAction(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string ElementsError(const json& array) {
  return ErrorOfAction([&] { ElementsFrom(array); });
}

json Element(const std::string& name, const std::string& text) {
  return {{"name", name},
          {"role", "text"},
          {"text", text},
          {"is_changing", false},
          {"box", {1, 2.5, 30, 40}}};
}

TEST(MessageSplitter, TakesMessagesAsTheyCome) {
  MessageSplitter messages(100);
  EXPECT_EQ(messages.Take(), std::nullopt);
  messages.Add("{\"a\"");
  EXPECT_EQ(messages.Take(), std::nullopt);
  messages.Add(std::string(":1}\0{}\0{\"b", 10));
  EXPECT_EQ(messages.Take(), "{\"a\":1}");
  EXPECT_EQ(messages.Take(), "{}");
  EXPECT_EQ(messages.Take(), std::nullopt);
  messages.Add(std::string("\":2}\0", 5));
  EXPECT_EQ(messages.Take(), "{\"b\":2}");
}

TEST(MessageSplitter, RefusesAMessageThatIsTooLongBeforeItHasEnded) {
  MessageSplitter messages(10);
  messages.Add(std::string(10, 'x'));
  EXPECT_EQ(messages.Take(), std::nullopt);
  messages.Add("x");
  EXPECT_THAT(ErrorOfAction([&] { (void)messages.Take(); }), HasSubstr("more than 10 bytes"));
}

TEST(BrowserMessages, AreAnswersOrEvents) {
  const BrowserMessage answer = ParseBrowserMessage(R"({"id":7,"result":{"a":1},"sessionId":"S"})");
  EXPECT_EQ(answer.call, 7);
  EXPECT_EQ(answer.session, "S");
  EXPECT_EQ(answer.content, json({{"a", 1}}));
  EXPECT_EQ(answer.error, std::nullopt);
  const BrowserMessage event = ParseBrowserMessage(R"({"method":"Page.loaded","params":{"b":2}})");
  EXPECT_EQ(event.call, std::nullopt);
  EXPECT_EQ(event.method, "Page.loaded");
  EXPECT_EQ(event.content, json({{"b", 2}}));
  const BrowserMessage error =
      ParseBrowserMessage("{\"id\":8,\"error\":{\"code\":-1,\"message\":\"No\\u001b[31m such\"}}");
  EXPECT_EQ(error.error, "No\uFFFD[31m such") << "in one line, for a terminal";
}

TEST(BrowserMessages, ThatAreNoneAreRefusedWithTheReason) {
  const auto error_of = [](const std::string& text) {
    return ErrorOfAction([&] { ParseBrowserMessage(text); });
  };
  for (const char* text :
       {"", "{", "[]", "7", "{}", R"({"id":"7"})", R"({"id":1.5})", R"({"id":1,"result":[]})",
        R"({"method":7})", R"({"method":"a","params":7})", R"({"id":1,"error":"no"})",
        R"({"method":"a","sessionId":null})"}) {
    EXPECT_THAT(error_of(text), HasSubstr("the browser has sent what is no message: ")) << text;
  }
  const std::string deep = R"({"method":"a","params":{"x":)" + std::string(100'000, '[');
  EXPECT_THAT(error_of(deep), HasSubstr("nested too deeply"));
}

TEST(BrowserMessages, ACallHasNumberMethodAndSession) {
  const std::string text = CallText(3, "Page.enable", {{"a", 1}}, "S");
  ASSERT_EQ(text.back(), '\0');
  EXPECT_EQ(
      json::parse(text.substr(0, text.size() - 1)),
      json({{"id", 3}, {"method", "Page.enable"}, {"params", {{"a", 1}}}, {"sessionId", "S"}}));
  EXPECT_EQ(CallText(3, "a", json::object(), "").find("sessionId"), std::string::npos);
}

TEST(PageElements, AreReadWithTheirBox) {
  json array = json::array({Element("rate", "60.0 Hz")});
  array[0]["is_changing"] = true;
  const auto elements = ElementsFrom(array);
  ASSERT_EQ(elements.size(), 1u);
  EXPECT_EQ(elements[0].name, "rate");
  EXPECT_EQ(elements[0].role, "text");
  EXPECT_EQ(elements[0].text, "60.0 Hz");
  EXPECT_EQ(elements[0].x_px, 1);
  EXPECT_EQ(elements[0].y_px, 2.5);
  EXPECT_EQ(elements[0].width_px, 30);
  EXPECT_EQ(elements[0].height_px, 40);
  EXPECT_TRUE(elements[0].is_changing);
}

TEST(PageElements, OfEqualNamesHaveNumbersThatNoOtherHas) {
  json array = json::array();
  for (const char* name : {"p", "p (2)", "p", "p", "p (2)"}) array.push_back(Element(name, "a"));
  std::vector<std::string> names;
  for (const PageElement& each : ElementsFrom(array)) names.push_back(each.name);
  EXPECT_THAT(names, ElementsAre("p", "p (2)", "p (3)", "p (4)", "p (2) (2)"));
}

TEST(PageElements, OfAPageHaveNoPowerOverTheTerminal) {
  EXPECT_EQ(ElementsFrom(json::array({Element("a", "x\u001b[2J\ny")}))[0].text,
            "x\uFFFD[2J\uFFFDy");
}

TEST(PageElements, ThatAreNoneAreRefusedWithTheReason) {
  EXPECT_THAT(ElementsError(json::object()), HasSubstr("its elements are no list"));
  EXPECT_THAT(ElementsError(json::array({7})), HasSubstr("an element is no object"));
  EXPECT_THAT(ElementsError(json::array_t(5001)),
              HasSubstr("5001 elements; expected at most 5000"));
  const auto with = [](const char* member, json value) {
    json element = Element("a", "b");
    element[member] = std::move(value);
    return json::array({std::move(element)});
  };
  EXPECT_THAT(ElementsError(with("name", 7)), HasSubstr("name is no text"));
  EXPECT_THAT(ElementsError(with("name", "")), HasSubstr("no name"));
  EXPECT_THAT(ElementsError(with("role", "")), HasSubstr("no role"));
  EXPECT_THAT(ElementsError(with("text", std::string(2001, 'x'))),
              HasSubstr("text has 2001 bytes"));
  EXPECT_THAT(ElementsError(with("box", {1, 2, 3})), HasSubstr("no box"));
  EXPECT_THAT(ElementsError(with("box", {1, 2, 3, "4"})), HasSubstr("no numbers"));
  EXPECT_THAT(ElementsError(with("box", {1, 2, 3, 1e9})), HasSubstr("too large"));
  EXPECT_THAT(ElementsError(with("is_changing", nullptr)), HasSubstr("is_changing"));
}

TEST(Base64, GivesBytes) {
  EXPECT_THAT(BytesFromBase64(""), ElementsAre());
  EXPECT_THAT(BytesFromBase64("TQ=="), ElementsAre('M'));
  EXPECT_THAT(BytesFromBase64("TWE="), ElementsAre('M', 'a'));
  EXPECT_THAT(BytesFromBase64("TWFu"), ElementsAre('M', 'a', 'n'));
  EXPECT_THAT(BytesFromBase64("/+8A"), ElementsAre(0xFF, 0xEF, 0));
  EXPECT_THAT(ErrorOfAction([] { BytesFromBase64("TW!u"); }), HasSubstr("no base64"));
}

}  // namespace
}  // namespace kinescope::app
