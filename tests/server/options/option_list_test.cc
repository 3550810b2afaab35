#include "server/options/option_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "server/app/serve/serve_options.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using testing::TempFolder;

std::string Write(const TempFolder& folder, const std::string& text) {
  const auto path = folder.path() / "options.yaml";
  std::ofstream(path) << text;
  return path.string();
}

ServeOptions Read(const std::vector<std::string>& arguments, const std::string& yaml,
                  const std::map<std::string, std::string>& params) {
  CLI::App app;
  ServeOptions options;
  options.Visit(FlagAdder(app, "source"));
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  app.parse(reversed);
  if (!yaml.empty()) options.Visit(ValueSetter(app, YamlValues(yaml)));
  options.Visit(ValueSetter(app, [&](const std::string& name) -> std::optional<std::string> {
    const auto found = params.find(name);
    if (found == params.end()) return std::nullopt;
    return found->second;
  }));
  return options;
}

template <class F>
std::string ErrorOf(F&& f) {
  try {
    f();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OptionList, LetsTheCommandLineWinOverParametersOverYaml) {
  const TempFolder folder;
  const std::string yaml = Write(folder, "http_port: 1\ntf: tree\nmass: 80\nloop: true\n");
  const ServeOptions options =
      Read({"demo:lift", "--http_port=3"}, yaml, {{"http_port", "2"}, {"tf", "off"}});
  EXPECT_EQ(options.source, "demo:lift");
  EXPECT_EQ(options.http_port, 3);
  EXPECT_EQ(options.tf, "off");
  EXPECT_EQ(options.person.mass, 80);
  EXPECT_TRUE(options.loop);
}

TEST(OptionList, NamesTheOptionTheValueAndWhatItShouldBe) {
  EXPECT_EQ(ErrorOf([] {
              Read({}, "", {{"http_port", "80a"}});
            }),
            "http_port=80a: expected a whole number");
  EXPECT_EQ(ErrorOf([] { Read({}, "", {{"mass", "heavy"}}); }), "mass=heavy: expected a number");
  EXPECT_EQ(ErrorOf([] { Read({}, "", {{"loop", "yes"}}); }), "loop=yes: expected true or false");
}

TEST(YamlValues, SayWhereTheFileIsWrong) {
  const TempFolder folder;
  EXPECT_EQ(ErrorOf([] { YamlValues("/nowhere.yaml"); }),
            "--config=/nowhere.yaml: no such file, or it may not be read");
  const std::string list = Write(folder, "- 1\n- 2\n");
  EXPECT_NE(ErrorOf([&] { YamlValues{list}; }).find("expected lines of"), std::string::npos);
  const std::string broken = Write(folder, "tf: tree\nloop: [\n");
  EXPECT_NE(ErrorOf([&] { YamlValues{broken}; }).find("line "), std::string::npos);
  const std::string unknown = Write(folder, "tf: tree\ncolour: red\n");
  const std::string error = ErrorOf([&] { YamlValues(unknown).RefuseUnknown({"tf"}); });
  EXPECT_NE(error.find("line 2: no option is called 'colour'"), std::string::npos) << error;
}

}  // namespace
}  // namespace kinescope::app
