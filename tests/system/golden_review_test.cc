// A review of a failing run as the browser of a person does it, and as others must not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "server/app/golden/golden_lock.h"
#include "tests/server/http/test_client.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using http::testing::Fetch;
using http::testing::Headers;
using http::testing::Response;
using nlohmann::json;
using ::testing::AllOf;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::MatchesRegex;
using ::testing::Not;
using testing::Process;
using testing::ProgramResult;
using testing::ReadFile;
using testing::TempFolder;

ProgramResult GoldenOnce(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "golden");
  return Kinescope(std::move(arguments), {"CI="});
}

// `kinescope golden review`, and what its page sends.
class Reviewing {
 public:
  explicit Reviewing(const fs::path& run, const std::vector<std::string>& more = {})
      : process_(Command(run, more)) {
    const auto line = process_.ReadLine(std::chrono::seconds(30));
    url_ = line.value_or("");
    const std::string base = "http://127.0.0.1:", query = "/?token=";
    const std::size_t at = url_.find(query);
    if (url_.compare(0, base.size(), base) != 0 || at == std::string::npos) {
      throw std::runtime_error("no address: " + url_);
    }
    port_ = std::stoi(url_.substr(base.size()));
    token_ = url_.substr(at + query.size());
  }

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  Headers Allowed(Headers headers = {}) const {
    headers.emplace("Authorization", "Bearer " + token_);
    return headers;
  }
  Response Get(const std::string& target) const { return Fetch(port_, target, Allowed()); }
  Response Post(const std::string& path, const json& body) const {
    return Fetch(port_, path, Allowed(), "POST", body.dump());
  }
  Response Order(const std::string& name, const std::string& order) const {
    return Post("/decisions", {{"case", name}, {"order", order}});
  }
  json Decisions() const { return Get("/decisions").json().at("decisions"); }

  /// Its exit code; `out` gets what it has printed after the address.
  int End(std::string* out = nullptr) {
    while (const auto line = process_.ReadLine(std::chrono::seconds(30))) {
      if (out != nullptr) *out += *line + "\n";
    }
    return process_.WaitForEnd();
  }
  int Interrupt(std::string* out = nullptr) {
    process_.Signal(SIGINT);
    return End(out);
  }

 private:
  static std::vector<std::string> Command(const fs::path& run,
                                          const std::vector<std::string>& more) {
    std::vector<std::string> command = {"/usr/bin/env", "CI=",    testing::KinescopePath(),
                                        "golden",       "review", run};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  Process process_;
  std::string url_, token_;
  int port_ = 0;
};

class GoldenReviewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteCase("bend", kCase);
    WriteCase("reach", kCase);
    ASSERT_EQ(GoldenOnce({"update", folder_.path()}).exit_code, 0);
    accepted_ = Content();
    WriteCase("bend", kCase + std::string("hide: cop\n"));
    WriteCase("reach", kCase + std::string("background: '#e0e0e0'\n"));
    ASSERT_EQ(Check().exit_code, 1);
  }
  ProgramResult Check() const { return GoldenOnce({"check", folder_.path(), "--out", run_}); }
  void WriteCase(const std::string& name, const std::string& yaml) const {
    std::ofstream(folder_ / (name + ".yaml")) << yaml;
  }
  // All that is accepted.
  std::string Content() const {
    std::string content = ReadFile(folder_ / "golden.lock");
    for (const char* name : {"bend.png", "reach.png", "c_new.png"}) {
      content += fs::exists(folder_ / name) ? ReadFile(folder_ / name) : "none";
    }
    return content;
  }
  void ExpectNothingAccepted() const { EXPECT_EQ(Content(), accepted_); }
  void ChangeRun(const std::string& before, const std::string& now) const {
    std::string text = ReadFile(run_ / "run.json");
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << before;
    std::ofstream(run_ / "run.json") << text.replace(at, before.size(), now);
  }

  static constexpr char kCase[] = "source: demo:lift\ntime: 2\ncamera: right\nsize: 160x90\n";
  TempFolder folder_;
  const fs::path run_ = folder_ / "run";
  std::string accepted_;
};

TEST_F(GoldenReviewTest, AcceptsAPictureAtOnce) {
  Reviewing review(run_);
  const Response response = review.Order("bend", "accept");
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.json().at("decisions"), json({{"bend", "accepted"}}));
  EXPECT_EQ(ReadFile(folder_ / "bend.png"), ReadFile(run_ / "bend.actual.png"));
  const app::GoldenLock lock = app::ReadLock(folder_ / "golden.lock");
  EXPECT_EQ(lock.at("bend").options.count("hide"), 1u);
  EXPECT_EQ(lock.at("reach").options.count("background"), 0u);
  EXPECT_EQ(GoldenOnce({"check", folder_.path(), "bend", "--out", folder_ / "again"}).exit_code, 0);
}

TEST_F(GoldenReviewTest, EndsOnThePageWhenEachCaseIsDecided) {
  Reviewing review(run_);
  ASSERT_EQ(review.Order("bend", "accept").status, 200);
  const Response early = review.Post("/end", json::object());
  EXPECT_EQ(early.status, 409);
  EXPECT_THAT(early.json().at("error").get<std::string>(), HasSubstr("1 case is undecided"));
  ASSERT_EQ(review.Order("reach", "accept").status, 200);
  EXPECT_EQ(review.Post("/end", json::object()).status, 200);
  std::string out;
  EXPECT_EQ(review.End(&out), 0);
  EXPECT_THAT(out, HasSubstr("bend                     accepted\nreach                    "
                             "accepted\n2 accepted, 0 rejected, 0 for later, 0 undecided\n"));
}

TEST_F(GoldenReviewTest, KeepsDecisionsForTheNextReviewAndListsThem) {
  {
    Reviewing review(run_);
    ASSERT_EQ(review.Order("bend", "later").status, 200);
    ASSERT_EQ(review.Order("reach", "reject").status, 200);
    EXPECT_EQ(review.Decisions(), json({{"bend", "later"}, {"reach", "rejected"}}));
    std::string out;
    EXPECT_EQ(review.Interrupt(&out), 1);
    EXPECT_THAT(out, AllOf(HasSubstr("bend                     later"),
                           HasSubstr("reach                    rejected"),
                           HasSubstr("0 accepted, 1 rejected, 1 for later, 0 undecided"),
                           HasSubstr("golden review " + run_.string())));
  }
  ExpectNothingAccepted();
  {
    Reviewing review(run_);
    EXPECT_EQ(review.Decisions(), json({{"bend", "later"}, {"reach", "rejected"}}));
    ASSERT_EQ(review.Order("reach", "undo").status, 200);
    ASSERT_EQ(review.Order("bend", "accept").status, 200);
    EXPECT_EQ(review.Decisions(), json({{"bend", "accepted"}}));
    EXPECT_EQ(review.Interrupt(), 1);
  }
  EXPECT_EQ(Reviewing(run_).Decisions(), json({{"bend", "accepted"}}));
}

TEST_F(GoldenReviewTest, KeepsADecisionAboutAPictureAsLongAsThatIsDrawn) {
  ASSERT_EQ(Reviewing(run_).Order("bend", "reject").status, 200);
  ASSERT_EQ(Check().exit_code, 1);
  EXPECT_EQ(Reviewing(run_).Decisions(), json({{"bend", "rejected"}}));
  WriteCase("bend", kCase + std::string("background: '#d0d0d0'\n"));
  ASSERT_EQ(Check().exit_code, 1);
  EXPECT_EQ(Reviewing(run_).Decisions(), json::object());
}

TEST_F(GoldenReviewTest, UndoRestoresWhatWasAcceptedBefore) {
  WriteCase("c_new", kCase);
  ASSERT_EQ(Check().exit_code, 2);
  Reviewing review(run_);
  for (const std::string name : {"bend", "c_new"}) {
    ASSERT_EQ(review.Order(name, "accept").status, 200);
    EXPECT_NE(Content(), accepted_);
    ASSERT_EQ(review.Order(name, "undo").status, 200);
    EXPECT_EQ(Content(), accepted_) << name;
  }
  ASSERT_EQ(review.Order("bend", "accept").status, 200);
  ASSERT_EQ(review.Order("bend", "reject").status, 200) << "which undoes it first";
  EXPECT_EQ(Content(), accepted_);
  EXPECT_EQ(review.Decisions(), json({{"bend", "rejected"}}));
}

// A file of the run could come from a stranger.
TEST_F(GoldenReviewTest, UndoesNothingThatAnotherReviewHasAccepted) {
  ASSERT_EQ(Reviewing(run_).Order("bend", "accept").status, 200);
  const std::string taken = Content();
  const Reviewing review(run_);
  for (const char* order : {"undo", "reject", "later"}) {
    const Response response = review.Order("bend", order);
    EXPECT_EQ(response.status, 409);
    EXPECT_THAT(response.json().at("error").get<std::string>(),
                AllOf(HasSubstr("accepted before this review began"), HasSubstr("bend.png")));
  }
  EXPECT_EQ(Content(), taken);
}

TEST_F(GoldenReviewTest, UndoesNothingThatWasChangedBesideIt) {
  const Reviewing review(run_);
  ASSERT_EQ(review.Order("bend", "accept").status, 200);
  fs::copy_file(run_ / "reach.actual.png", folder_ / "bend.png",
                fs::copy_options::overwrite_existing);
  const std::string changed = Content();
  EXPECT_EQ(review.Order("bend", "undo").status, 409);
  EXPECT_EQ(Content(), changed);
  EXPECT_EQ(review.Decisions(), json::object());
}

TEST_F(GoldenReviewTest, SeesWhatOtherCommandsAccept) {
  const Reviewing review(run_);
  ASSERT_EQ(GoldenOnce({"accept", run_, "reach"}).exit_code, 0);
  EXPECT_EQ(review.Decisions(), json({{"reach", "accepted"}}));
}

TEST_F(GoldenReviewTest, RefusesWhatAcceptRefusesWithTheSameReason) {
  const Reviewing review(run_);
  const auto reason = [&](const std::string& name) {
    const Response response = review.Order(name, "accept");
    EXPECT_EQ(response.status, 409) << response.body;
    ExpectNothingAccepted();
    const ProgramResult same = GoldenOnce({"accept", run_, name});
    const auto error = response.json().at("error").get<std::string>();
    EXPECT_THAT(same.out, HasSubstr(error));
    EXPECT_FALSE(response.json().at("decisions").contains(name));
    return error;
  };
  WriteCase("bend", kCase + std::string("hide: cop\nmass: 90\n"));
  EXPECT_THAT(reason("bend"), HasSubstr("its case is not that of the run (mass: added, 90)"));
  render::WritePng(run_ / "reach.actual.png", render::ReadPng(folder_ / "reach.png"));
  EXPECT_THAT(reason("reach"), HasSubstr("is not the picture of the run"));
}

TEST_F(GoldenReviewTest, TakesAnotherEnvironmentOnlyIfItIsTold) {
  ChangeRun("\"backend\": \"osmesa\"", "\"backend\": \"egl\"");
  EXPECT_THAT(Reviewing(run_).Order("bend", "accept").body, HasSubstr("in another environment"));
  ExpectNothingAccepted();
  EXPECT_EQ(Reviewing(run_, {"--other_environment"}).Order("bend", "accept").status, 200);
}

TEST_F(GoldenReviewTest, RefusesRequestsThatAreNotOfItsPage) {
  const Reviewing review(run_);
  const std::string order = R"({"case": "bend", "order": "accept"})";
  const auto post = [&](const Headers& headers) {
    return Fetch(review.port(), "/decisions", headers, "POST", order).status;
  };
  EXPECT_EQ(post({}), 401);
  EXPECT_EQ(post({{"Authorization", "Bearer " + std::string(32, 'a')}}), 401);
  EXPECT_EQ(post(review.Allowed({{"Host", "evil.example"}})), 403);
  EXPECT_EQ(post(review.Allowed({{"Host", "localhost:1"}})), 403);
  EXPECT_EQ(post(review.Allowed({{"Origin", "http://evil.example"}})), 403);
  EXPECT_EQ(Fetch(review.port(), "/?token=wrong").status, 401)
      << "the page is for its person alone";
  EXPECT_EQ(Fetch(review.port(), "/decisions").status, 401);
  for (const char* name : {"same", "", "../bend", "bend.png", "/etc/passwd", "golden.lock: bend"}) {
    EXPECT_EQ(review.Order(name, "accept").status, 404) << name;
  }
  EXPECT_EQ(review.Order("bend", "remove").status, 400);
  for (const json& body : {json(nullptr), json("bend"), json({{"case", "bend"}}),
                           json({{"case", 7}, {"order", "accept"}})}) {
    EXPECT_EQ(review.Post("/decisions", body).status, 400) << body;
  }
  EXPECT_EQ(review.Get("/report.html").status, 404);
  EXPECT_EQ(review.Get("/end").status, 404) << "to get something changes nothing";
  EXPECT_EQ(review.Get("/decisions?case=bend&order=accept").status, 200);
  ExpectNothingAccepted();
  EXPECT_FALSE(fs::exists(run_ / "review.json"));
}

TEST_F(GoldenReviewTest, ServesAPageThatRunsNoScriptOfTheRun) {
  ChangeRun("\"folder\": \"", "\"kinescope\": \"<script>alert(1)</script>\", \"folder\": \"");
  ChangeRun("\"name\": \"objects\"", "\"name\": \"<img src=x onerror=alert(1)>\"");
  std::ofstream(run_ / "report.html") << "<script>alert('stranger')</script>";
  const Reviewing review(run_);
  const Response page = Fetch(review.port(), "/?token=" + review.token());
  EXPECT_EQ(page.status, 200);
  const std::string policy = page.headers.at("content-security-policy");
  EXPECT_THAT(policy, MatchesRegex("default-src 'none'; img-src data:; style-src 'nonce-.*'; "
                                   "script-src 'nonce-.*'; connect-src 'self'; base-uri 'none'; "
                                   "form-action 'none'; frame-ancestors 'none'"));
  EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
  EXPECT_THAT(
      page.body,
      AllOf(HasSubstr("2 of 2 pictures differ"), HasSubstr("data-token=\"" + review.token() + "\""),
            Not(HasSubstr("stranger")), Not(HasSubstr("<img")), Not(HasSubstr("<script>"))));
  EXPECT_THAT(ReadFile(run_ / "report.html"), Not(HasSubstr(review.token())));
}

TEST_F(GoldenReviewTest, RefusesARunThatLeadsOutOfItsFolder) {
  ChangeRun("\"case\": \"bend\"", "\"case\": \"../bend\"");
  ExpectRefusal(GoldenOnce({"review", run_}), "case '../bend'; expected the name of a file");
  ExpectRefusal(GoldenOnce({"accept", run_}), "case '../bend'; expected the name of a file");
  ChangeRun("\"case\": \"../bend\"", "\"case\": \"reach\"");
  ExpectRefusal(GoldenOnce({"review", run_}), "case 'reach' is there twice");
}

TEST_F(GoldenReviewTest, RefusesWhatItCannotReview) {
  ExpectRefusal(Kinescope({"golden", "review", run_}, {"CI=true"}), "CI=true");
  ExpectRefusal(GoldenOnce({"review", folder_.path()}), "run.json");
  ExpectRefusal(GoldenOnce({"review", run_, "--folder", folder_ / "nowhere"}), "nowhere");
  ExpectRefusal(GoldenOnce({"review", run_, "--port", "70000"}), "--port=70000");
  std::ofstream(run_ / "review.json") << "{\"schema\": 1, \"decisions\": [{\"case\": \"bend\", "
                                         "\"decision\": \"accepted\", \"pixels\": \"\", "
                                         "\"accepted_pixels\": \"\"}]}";
  ExpectRefusal(GoldenOnce({"review", run_}), "decision 'accepted'; expected rejected or later");
}

TEST_F(GoldenReviewTest, HasNothingToServeWhereAllIsTheSame) {
  WriteCase("bend", kCase);
  WriteCase("reach", kCase);
  ASSERT_EQ(Check().exit_code, 0);
  const ProgramResult same = GoldenOnce({"review", run_});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_THAT(same.out, HasSubstr("nothing to review"));
  WriteCase("broken", "source: nowhere.mvnx\n");
  ASSERT_EQ(Check().exit_code, 2);
  const ProgramResult broken = GoldenOnce({"review", run_});
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.out,
              AllOf(HasSubstr("broken                   has no picture to decide about"),
                    HasSubstr("nowhere.mvnx")));
}

}  // namespace
}  // namespace kinescope
