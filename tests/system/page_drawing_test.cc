// Pages drawn by the real Chromium: what is on them is read, what cannot be drawn is said, and
// nothing is left behind.
#include "server/app/golden/page_drawing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/system/stop_signal.h"
#include "server/app/golden/page_browser.h"
#include "tests/shared_data.h"
#include "tests/system/small_web_server.h"
#include "tests/taken_port.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::SmallWebServer;
using testing::TempFolder;

// The variable has another value while this object exists.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* const name_;
  std::optional<std::string> before_;
};

// Of processes that have `text` among their arguments.
int CountOfProcesses(const std::string& text) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    // A process may end between the two: then this reads nothing, where ReadFile() throws.
    std::ostringstream arguments;
    arguments << std::ifstream(entry.path() / "cmdline").rdbuf();
    if (arguments.str().find(text) != std::string::npos) ++count;
  }
  return count;
}

// Why it cannot be drawn; "" if it can.
std::string WhyNot(const PageSpec& spec) {
  try {
    DrawPage(spec);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

const PageElement& ElementOf(const PageDrawing& drawing, const std::string& name) {
  for (const PageElement& each : drawing.elements) {
    if (each.name == name) return each;
  }
  std::string names;
  for (const PageElement& each : drawing.elements) names += "\n  " + each.name + ": " + each.text;
  throw std::runtime_error("no element '" + name + "' among" + names);
}

std::vector<std::string> NamesOf(const PageDrawing& drawing) {
  std::vector<std::string> names;
  for (const PageElement& each : drawing.elements) names.push_back(each.name);
  return names;
}

class PageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      chromium_ = FindChromium();
    } catch (const std::runtime_error& missing) {
      GTEST_SKIP() << missing.what();
    }
  }

  PageSpec PageOf(const std::string& html) const {
    std::ofstream(folder_ / "page.html") << "<!doctype html><meta charset=utf-8>" << html;
    return Small("file://" + (folder_ / "page.html").string());
  }
  PageSpec Small(const std::string& url) const {
    PageSpec spec;
    spec.url = url;
    spec.width_px = 400;
    spec.height_px = 500;
    spec.chromium = chromium_;
    return spec;
  }

  TempFolder folder_;
  fs::path chromium_;
};

constexpr char kPage[] = R"html(<title>A page</title>
<style>body { margin: 0; font: 20px sans-serif; background: #204060; color: #fff } dl { margin: 0 }
.away { display: none } .clear { opacity: 0 } .unseen { visibility: hidden }
.said { position: absolute; width: 1px; height: 1px; overflow: hidden }
ol { height: 50px; overflow: hidden; margin: 0 } li { height: 25px; display: flex; gap: 9px }</style>
<h1>Two <em>people</em></h1>
<dl><dt>Rate</dt><dd>60.0 Hz</dd><dt>Sample</dt><dd id=sample>17</dd></dl>
<button aria-pressed=true>Start</button><button id=stop disabled>Stop</button><button aria-label=Close>×</button>
<label>Mass <input value=75></label><input id=quick type=checkbox checked>
<p class=away>away</p><p class=clear>clear</p><p class=unseen>unseen</p><p class=said>said</p>
<canvas width=40 height=10 aria-label="The view"></canvas>
<p>It is <span data-changing>12:00</span> now.</p>
<ol><li><b>Knee</b><span class=ratio>72 %</span></li><li><b>Hip</b><span class=ratio>9 %</span></li>
<li><b>Neck</b><span class=ratio>1 %</span></li></ol>
)html";

TEST_F(PageTest, IsDrawnInItsSizeAndReadAsAPersonReadsIt) {
  const PageDrawing drawing = DrawPage(PageOf(kPage));
  ASSERT_EQ(drawing.image.width, 400);
  ASSERT_EQ(drawing.image.height, 500);
  const auto* const corner = &drawing.image.rgba[4 * (400 * 500 - 1)];
  EXPECT_THAT(std::vector<int>(corner, corner + 4), ElementsAre(0x20, 0x40, 0x60, 255));
  EXPECT_THAT(drawing.browser, HasSubstr("Chromium 1"));
  EXPECT_EQ(ElementOf(drawing, "Two people").role, "heading");
  EXPECT_EQ(ElementOf(drawing, "Rate").text, "60.0 Hz");
  EXPECT_EQ(ElementOf(drawing, "sample").text, "17");
  EXPECT_EQ(ElementOf(drawing, "Start").role, "button");
  EXPECT_EQ(ElementOf(drawing, "Start").text, "Start [pressed]");
  EXPECT_EQ(ElementOf(drawing, "stop").text, "Stop [disabled]");
  EXPECT_EQ(ElementOf(drawing, "Close").text, "×");
  EXPECT_EQ(ElementOf(drawing, "Mass").text, "75");
  EXPECT_EQ(ElementOf(drawing, "quick").text, "checked");
  EXPECT_EQ(ElementOf(drawing, "The view").role, "canvas");
  EXPECT_EQ(ElementOf(drawing, "Knee ratio").text, "72 %");
  EXPECT_EQ(ElementOf(drawing, "Hip ratio").text, "9 %");
  const PageElement& heading = ElementOf(drawing, "Two people");
  EXPECT_GT(heading.width_px, 100);
  EXPECT_LT(heading.width_px, 250) << "the words, not the line";
  EXPECT_GT(ElementOf(drawing, "sample").y_px, heading.y_px + heading.height_px);
}

TEST_F(PageTest, WhatIsNotSeenIsNotRead) {
  const PageDrawing drawing = DrawPage(PageOf(kPage));
  for (const PageElement& each : drawing.elements) {
    for (const char* hidden : {"away", "clear", "unseen", "said", "Neck", "A page"}) {
      EXPECT_THAT(each.text, Not(HasSubstr(hidden)));
    }
  }
}

TEST_F(PageTest, DrawnTwiceIsTheSameToTheByte) {
  const PageSpec spec = PageOf(kPage);
  const PageDrawing one = DrawPage(spec), other = DrawPage(spec);
  EXPECT_EQ(one.image.rgba, other.image.rgba);
  EXPECT_EQ(one.elements, other.elements);
  EXPECT_EQ(FindChange(one, other), std::nullopt);
}

TEST_F(PageTest, AChangedDigitIsFoundAndNamed) {
  const PageDrawing one = DrawPage(PageOf(kPage));
  std::string changed = kPage;
  changed.replace(changed.find("60.0 Hz"), 4, "60.1");
  const auto change = FindChange(one, DrawPage(PageOf(changed)));
  ASSERT_TRUE(change);
  EXPECT_THAT(*change, HasSubstr("'Rate' (60.0 Hz)"));
}

TEST_F(PageTest, AChangeWithoutWordsIsFoundByItsPlace) {
  const PageDrawing one = DrawPage(PageOf("<div style='width:30px;height:20px;background:#123'>"));
  const PageDrawing other =
      DrawPage(PageOf("<div style='width:30px;height:20px;background:#124'>"));
  EXPECT_EQ(FindChange(one, other), "30x20 px at x 8, y 8");
}

TEST_F(PageTest, WhatChangesByItselfHasNoWordsAndIsNoChange) {
  const PageDrawing one = DrawPage(PageOf(kPage));
  const auto is_changing = [](const PageElement& each) { return each.is_changing; };
  EXPECT_EQ(std::count_if(one.elements.begin(), one.elements.end(), is_changing), 1);
  for (const PageElement& each : one.elements) EXPECT_THAT(each.text, Not(HasSubstr("12:00")));
  std::string later = kPage;
  later.replace(later.find("12:00"), 5, "12:09");
  EXPECT_EQ(FindChange(one, DrawPage(PageOf(later))), std::nullopt);
}

TEST_F(PageTest, AClockThatSaysThatItChangesKeepsNoPictureFromBeingDrawn) {
  const PageDrawing drawing = DrawPage(
      PageOf("<p>Fixed</p><p data-changing id=clock>0</p><script>let n = 0; setInterval(() => { "
             "document.getElementById('clock').textContent = ++n; }, 5);</script>"));
  EXPECT_THAT(NamesOf(drawing), ElementsAre("p", "clock"));
}

TEST_F(PageTest, APageThatNeverStandsStillIsRefusedWithThePlaceAndTheWayOut) {
  PageSpec spec = PageOf(
      "<p id=count>0</p><script>let n = 0; setInterval(() => { "
      "document.getElementById('count').textContent = ++n; }, 5);</script>");
  spec.limit = milliseconds(6000);
  EXPECT_THAT(WhyNot(spec), AllOf(HasSubstr("page: file://"), HasSubstr("not ready after 6 s"),
                                  HasSubstr("'count' ("), HasSubstr("data-changing")));
}

TEST_F(PageTest, AnimationsStandStillWhereTheyEnd) {
  const PageDrawing drawing = DrawPage(PageOf(
      "<style>@keyframes go { to { width: 100px } } div { width: 10px; height: 10px; background: "
      "red; animation: go 100s forwards }</style><div></div><input autofocus>"));
  const auto& rgba = drawing.image.rgba;
  EXPECT_EQ(rgba[4 * (12 * 400 + 100)], 255) << "wide";
  EXPECT_EQ(rgba[4 * (12 * 400 + 100) + 1], 0) << "red";
}

TEST_F(PageTest, TheClockOfThePageStandsStillWhereItIsSet) {
  PageSpec spec = PageOf(
      "<p id=date></p><p id=random></p><script>document.getElementById('date').textContent = new "
      "Date().toISOString() + ' ' + Date.now() + ' ' + (new Date() instanceof Date) + ' ' + new "
      "Date(0).getTime(); document.getElementById('random').textContent = Math.random();</script>");
  spec.date_millis = 1'577'880'000'000;
  const PageDrawing one = DrawPage(spec), other = DrawPage(spec);
  EXPECT_EQ(ElementOf(one, "date").text, "2020-01-01T12:00:00.000Z 1577880000000 true 0");
  EXPECT_EQ(ElementOf(one, "random").text, ElementOf(other, "random").text);
}

TEST_F(PageTest, IsDrawnWhenTheElementThatItIsReadyWithIsThere) {
  PageSpec spec = PageOf(
      "<p>Wait</p><script>setTimeout(() => { document.body.innerHTML = '<p id=done>Done</p>'; }, "
      "1500);</script>");
  spec.ready_when = "#done";
  EXPECT_EQ(ElementOf(DrawPage(spec), "done").text, "Done");
  spec.ready_when = "#never";
  spec.limit = milliseconds(4000);
  EXPECT_THAT(WhyNot(spec), HasSubstr("waited for an element '#never'"));
}

TEST_F(PageTest, ADialogOfThePageIsDismissed) {
  const PageDrawing drawing = DrawPage(
      PageOf("<p id=said></p><script>document.getElementById('said').textContent = confirm('Sure');"
             "</script>"));
  EXPECT_EQ(ElementOf(drawing, "said").text, "false");
}

TEST_F(PageTest, APageWhoseScriptNeverEndsIsRefused) {
  PageSpec spec = PageOf("<p>Busy</p><script>onload = () => { while (true); };</script>");
  spec.limit = milliseconds(4000);
  EXPECT_THAT(WhyNot(spec), HasSubstr("is not ready after 4 s"));
}

TEST_F(PageTest, APageWithTooManyThingsIsRefusedWithTheirNumber) {
  const PageSpec spec = PageOf(
      "<body style='font: 2px sans-serif'><script>for (let i = 0; i < 6000; ++i) { const p = "
      "document.body.appendChild(document.createElement('b')); p.style.cssText = "
      "'position:absolute;left:0;top:0'; p.textContent = 'word'; }</script>");
  EXPECT_THAT(WhyNot(spec), HasSubstr("the page has more than 5000 things to see"));
}

TEST_F(PageTest, OfAHugePageTheWindowIsDrawn) {
  const PageDrawing drawing =
      DrawPage(PageOf("<div style='width:99999px;height:500000px'>x</div>"));
  EXPECT_EQ(drawing.image.width, 400);
  EXPECT_EQ(drawing.image.height, 500);
  EXPECT_GT(drawing.content_height_px, 400'000);
}

TEST_F(PageTest, OnlyAddressesOfPagesAreOpened) {
  for (const char* url :
       {"chrome://version", "javascript:1", "data:text/html,a", "page.html", ""}) {
    EXPECT_THAT(WhyNot(Small(url)), HasSubstr("begins with http://, https:// or file://"));
  }
  PageSpec spec = PageOf("");
  spec.width_px = 9000;
  EXPECT_THAT(WhyNot(spec), HasSubstr("size 9000x500: expected 16 to 8192 px"));
}

TEST_F(PageTest, AnErrorOfTheServerIsNoPage) {
  const SmallWebServer server({{"/gone", {"404 Not Found", "text/html", "<h1>Not here</h1>"}},
                               {"/empty", {"500 Internal Server Error", "text/html", ""}},
                               {"/zip", {"200 OK", "application/zip", "PK"}},
                               {"/good", {"200 OK", "text/html", "<h1>Good</h1>"}}});
  EXPECT_THAT(WhyNot(Small(server.url() + "/gone")),
              AllOf(HasSubstr("/gone: "), HasSubstr("the server answers with 404")));
  EXPECT_THAT(WhyNot(Small(server.url() + "/empty")), HasSubstr("the server answers with 500"));
  EXPECT_THAT(WhyNot(Small(server.url() + "/zip")), HasSubstr("is a download and no page"));
  EXPECT_EQ(WhyNot(Small(server.url() + "/good")), "");
}

TEST_F(PageTest, RedirectionsWithoutEndAreRefused) {
  const SmallWebServer server(
      {{"/again", {"302 Found\r\nLocation: /again", "text/html", ""}},
       {"/script", {"200 OK", "text/html", "<script>location.reload()</script>"}}});
  EXPECT_THAT(WhyNot(Small(server.url() + "/again")),
              HasSubstr("cannot be loaded: net::ERR_TOO_MANY_REDIRECTS"));
  EXPECT_THAT(WhyNot(Small(server.url() + "/script")),
              AllOf(HasSubstr("leads from address to address without end"), HasSubstr("/script")));
}

TEST_F(PageTest, AServerThatIsNotThereIsNamed) {
  const std::string url = "http://127.0.0.1:" + testing::TakenPort(SOCK_DGRAM).number() + "/";
  EXPECT_THAT(WhyNot(Small(url)), AllOf(HasSubstr(url), HasSubstr("net::ERR_CONNECTION_REFUSED")));
  EXPECT_THAT(WhyNot(Small("file:///nothing/here.html")), HasSubstr("net::ERR_FILE_NOT_FOUND"));
}

TEST_F(PageTest, ATokenOfTheAddressIsNotSaid) {
  const std::string host = "http://127.0.0.1:" + testing::TakenPort(SOCK_DGRAM).number();
  const std::string why = WhyNot(Small(host + "/?token=0perator-of-the-lab&view=wall"));
  EXPECT_THAT(why, HasSubstr("page: " + host + "/?token=...&view=wall: cannot be loaded"));
  EXPECT_THAT(WhyNot(Small(host + "/?token=0perator-of-the-lab")), Not(HasSubstr("0perator")));
}

TEST_F(PageTest, NothingIsLeftOfIt) {
  const TempFolder temporary;
  const ScopedVariable variable("TMPDIR", temporary.path());
  EXPECT_EQ(WhyNot(PageOf("<p>Good</p>")), "");
  PageSpec bad = PageOf("<script>while (true);</script>");
  bad.limit = milliseconds(4000);
  EXPECT_NE(WhyNot(bad), "");
  EXPECT_THAT(temporary.Names(), IsEmpty());
  EXPECT_EQ(CountOfProcesses(temporary.path()), 0);
}

// Programs in the place of Chromium: file descriptor 4 is what Chromium writes.
class WrongBrowser : public ::testing::Test {
 protected:
  std::string WhyNotWith(const std::string& script,
                         milliseconds limit = milliseconds(20000)) const {
    const fs::path program = folder_ / "chromium";
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    PageSpec spec;
    spec.url = "file:///page.html";
    spec.limit = limit;
    const ScopedVariable variable("KINESCOPE_CHROMIUM", program);
    return WhyNot(spec);
  }

  TempFolder folder_;
};

TEST_F(WrongBrowser, ThatIsMissingIsSaidWithThePackage) {
  PageSpec spec;
  spec.url = "file:///page.html";
  {
    const ScopedVariable none("KINESCOPE_CHROMIUM", ""), path("PATH", folder_.path());
    EXPECT_EQ(WhyNot(spec),
              "page: file:///page.html: needs Chromium: install the package "
              "chromium-headless-shell or chromium, or set KINESCOPE_CHROMIUM to its path");
  }
  const ScopedVariable wrong("KINESCOPE_CHROMIUM", "/nothing/here");
  EXPECT_THAT(WhyNot(spec), HasSubstr("KINESCOPE_CHROMIUM=/nothing/here: is no program"));
}

TEST_F(WrongBrowser, ThatEndsIsSaidWithItsLastWords) {
  EXPECT_THAT(WhyNotWith("echo; echo 'no such library' >&2; exit 3"),
              HasSubstr("Chromium has ended with exit code 3: no such library"));
  EXPECT_THAT(WhyNotWith("kill -SEGV $$"), HasSubstr("signal 11"));
  EXPECT_THAT(WhyNotWith("echo 'No usable sandbox!' >&2; echo '#0 0x5' >&2; exit 1"),
              AllOf(HasSubstr("user namespaces"), HasSubstr("KINESCOPE_CHROMIUM")));
}

TEST_F(WrongBrowser, ThatSaysNothingIsEndedAfterTheLimit) {
  EXPECT_THAT(WhyNotWith("sleep 1000", milliseconds(300)),
              HasSubstr("is not ready after 0.3 s: waited for the start of Chromium"));
  EXPECT_EQ(CountOfProcesses(folder_.path()), 0);
}

TEST_F(WrongBrowser, ThatSendsNonsenseIsRefused) {
  EXPECT_THAT(WhyNotWith("printf 'hello\\0' >&4; sleep 1000"),
              HasSubstr("the browser has sent what is no message"));
  EXPECT_THAT(WhyNotWith("printf '{\"id\":1,\"result\":{\"product\":7}}\\0' >&4; sleep 1000"),
              HasSubstr("Chromium has answered otherwise than expected"));
  EXPECT_THAT(WhyNotWith("printf '{\"id\":1,\"error\":{\"message\":\"no\"}}\\0' >&4; sleep 1000"),
              HasSubstr(": no"));
}

TEST_F(WrongBrowser, ThatSendsWithoutEndIsRefusedBeforeMemoryIs) {
  EXPECT_THAT(WhyNotWith("yes >&4"), HasSubstr("has sent a message of more than"));
}

TEST_F(WrongBrowser, IsEndedWhenTheUserStopsTheProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        CatchStopSignals();
        std::cerr << WhyNotWith("kill -INT $PPID; sleep 1000") << CountOfProcesses(folder_.path());
        std::exit(7);
      },
      ::testing::ExitedWithCode(7), "page: file:///page.html: interrupted0");
}

}  // namespace
}  // namespace kinescope::app
