// `kinescope golden new | keys | list`: what is drawn.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/system/json_text.h"
#include "server/app/golden/golden_commands.h"
#include "server/app/golden/golden_new.h"
#include "server/app/print.h"
#include "server/app/shell_word.h"

namespace kinescope::app {
namespace {

struct NewCase {
  options::Text folder{"golden_images"}, name;
  GoldenCase described;
};

int WriteCase(const NewCase& values, const options::OptionList& given) {
  options::OptionList keys = given;
  keys.Remove({"folder", "name"});
  const auto path = WriteNewCase(*values.folder, *values.name, keys);
  Print("{}\nNext: kinescope golden check {} {} draws it, and says how to accept it\n",
        path.string(), ShellWord(*values.folder), ShellWord(*values.name));
  return 0;
}

struct CaseListOptions {
  GoldenCaseOptions cases;
  options::Flag json;
};

int ListAll(const CaseListOptions& options) {
  const GoldenSuite suite = options.cases.Find();
  for (const FoundCase& found : suite.cases) {
    const bool is_accepted = !suite.AcceptedPicturesOf(found).empty();
    const std::string why = found.read ? *found.read->why : found.error;
    if (*options.json) {
      Print("{}\n", JsonText(nlohmann::json{{"case", found.name},
                                            {"is_accepted", is_accepted},
                                            {"is_readable", found.read.has_value()},
                                            {"why", why}}));
      continue;
    }
    Print("{:<24} {:<13}{}{}\n", found.name, is_accepted ? "accepted" : "not accepted",
          found.read ? "" : "NOT READABLE: ", why);
  }
  for (const auto& file : suite.unread) {
    if (!*options.json) Print("{:<24} is not read: a case is called NAME.yaml\n", file.string());
  }
  for (const auto& orphan : suite.orphans) {
    if (*options.json) continue;
    Print("{:<24} belongs to no case\n", orphan.string());
  }
  return 0;
}

}  // namespace

Command GoldenNewCommand() {
  const auto values = std::make_shared<NewCase>();
  Command command;
  command.name = "new";
  command.about =
      "Writes a case: what to draw, and from which recording\n"
      "  kinescope golden new golden_images lift --source=lift.mvnx --time=2.5 --camera=right";
  command.options("folder", values->folder, "folder of the cases; made if there is none");
  command.options("name", values->name, "name of the case, and of its file");
  values->described.List(command.options);
  command.positionals = {"folder", "name"};
  command.required = {"folder", "name"};
  command.footer = "Paths are given from here; in the case they are relative to its file.";
  command.run = [values](options::OptionList& given) { return WriteCase(*values, given); };
  return command;
}

Command GoldenKeysCommand() {
  const auto json = std::make_shared<options::Flag>();
  Command keys;
  keys.name = "keys";
  keys.about = "Explains every key that a case may have, with its default";
  keys.options("json", *json, "print the keys as JSON");
  keys.run = [json](options::OptionList&) {
    PrintKeys(**json);
    return 0;
  };
  return keys;
}

Command GoldenListCommand() {
  const auto values = std::make_shared<CaseListOptions>();
  Command list;
  list.name = "list";
  list.about = "Lists the cases and their purposes, without drawing them";
  values->cases.List(list.options);
  list.options("json", values->json, "print the cases as JSON");
  list.positionals = {"folder", "case"};
  list.run = [values](options::OptionList&) { return ListAll(*values); };
  return list;
}

}  // namespace kinescope::app
