/// What an option's text stands for: a value that parses and prints itself, tells what it expects,
/// and which files it reads. Copied like any value; one thread at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/picture_limits.h"
#include "core/system/words.h"
#include "server/options/text.h"

namespace kinescope::options {

/// A text that a value refuses. what() is the reason: "expected male or female".
class BadValue : public std::runtime_error {
 public:
  /// `suggestion`: SuggestionFor() the word that is wrong, if the value knows which one it is.
  explicit BadValue(const std::string& reason, std::string suggestion = {})
      : std::runtime_error(reason), suggestion_(std::move(suggestion)) {}
  const std::string& suggestion() const { return suggestion_; }

 private:
  std::string suggestion_;
};

/// @throws BadValue: `word` is none of those that are `known`, and may mean one of them.
[[noreturn]] void RefuseWord(const std::string& word, const std::vector<std::string>& known);

/// A word of an earlier version in a text, and the word that has replaced it.
struct FormerWord {
  std::string former, current;
};

/// Null if `word` is in current use.
const FormerWord* FindFormer(const std::vector<FormerWord>& words, const std::string& word);

/// How a value stands in JSON.
enum class JsonKind { kText, kNumber, kTruth };

class Value {
 public:
  virtual ~Value() = default;

  /// From the command line, a YAML file or a ROS parameter. @throws BadValue; the value is then as
  /// before.
  virtual void Parse(const std::string& text) = 0;
  /// As Parse() reads it.
  virtual std::string ToText() const = 0;
  /// What Parse() takes, for --help and errors: "male or female", "0.05 to 60 s". "": any text.
  virtual std::string Expected() const = 0;
  /// False where nothing was given and there is no default: the option is then left out of
  /// provenance.
  virtual bool IsGiven() const { return true; }
  /// The words that it knows, for the nearest one to a wrong text.
  virtual std::vector<std::string> Names() const { return {}; }
  /// The files that decide what the value means.
  virtual std::vector<std::filesystem::path> Files() const { return {}; }
  /// Relative paths in the value, and in its text, are in `folder` instead of the current one.
  virtual void SetFolder(const std::filesystem::path& /*folder*/) {}
  virtual JsonKind json_kind() const { return JsonKind::kText; }
  /// Whether the option may be given several times; ParseAll() then gets all of its texts.
  virtual bool is_repeatable() const { return false; }
  virtual void ParseAll(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) Parse(text);
  }
  /// As ParseAll() reads them.
  virtual std::vector<std::string> ToTexts() const { return {ToText()}; }
  /// Words of an earlier version that were accepted so far.
  virtual std::vector<FormerWord> former_words() const { return {}; }

 protected:
  [[noreturn]] void RefuseText() const { throw BadValue("expected " + Expected()); }

  Value() = default;
  Value(const Value&) = default;
  Value& operator=(const Value&) = default;
};

/// A value of type T: reads like a `const T`.
template <class T>
class ValueOf : public Value {
 public:
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }

 protected:
  explicit ValueOf(T value) : value_(std::move(value)) {}

  T value_;
};

/// Any text, or what `is_good` lets pass.
class Text : public ValueOf<std::string> {
 public:
  explicit Text(std::string value = {}) : ValueOf(std::move(value)) {}
  Text(std::string value, std::string expected, bool (*is_good)(const std::string&))
      : ValueOf(std::move(value)), expected_(std::move(expected)), is_good_(is_good) {}
  Text& operator=(std::string value) {
    value_ = std::move(value);
    return *this;
  }

  void Parse(const std::string& text) override {
    if (is_good_ != nullptr && !is_good_(text)) RefuseText();
    value_ = text;
  }
  std::string ToText() const override { return value_; }
  std::string Expected() const override { return expected_; }

 private:
  std::string expected_;
  bool (*is_good_)(const std::string&) = nullptr;
};

/// A file that decides what is made; "": none.
class FilePath : public ValueOf<std::string> {
 public:
  FilePath() : ValueOf({}) {}

  void Parse(const std::string& text) override { value_ = text; }
  std::string ToText() const override { return value_; }
  std::string Expected() const override { return ""; }
  bool IsGiven() const override { return !value_.empty(); }
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;
};

/// Texts, one each time the option is given; in one text (YAML, ROS) with semicolons between them.
class Texts : public ValueOf<std::vector<std::string>> {
 public:
  Texts() : ValueOf({}) {}
  explicit Texts(std::string expected) : ValueOf({}), expected_(std::move(expected)) {}
  Texts& operator=(std::vector<std::string> values) {
    value_ = std::move(values);
    return *this;
  }

  void Parse(const std::string& text) override;
  void ParseAll(const std::vector<std::string>& texts) override { value_ = texts; }
  bool is_repeatable() const override { return true; }
  std::vector<std::string> ToTexts() const override { return value_; }
  std::string ToText() const override;
  std::string Expected() const override { return expected_; }

 private:
  std::string expected_;
};

/// One of a few words.
template <class T>
class Choice : public ValueOf<T> {
 public:
  using Words = std::vector<std::pair<std::string, T>>;

  /// @pre `value` has a word
  Choice(Words words, T value) : ValueOf<T>(value), words_(std::move(words)) {}
  Choice& operator=(T value) {
    this->value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override {
    for (const auto& [word, value] : words_) {
      if (word == text) {
        this->value_ = value;
        return;
      }
    }
    this->RefuseText();
  }
  std::string ToText() const override {
    for (const auto& [word, value] : words_) {
      if (value == this->value_) return word;
    }
    return "";
  }
  std::string Expected() const override { return Alternatives(Names()); }
  std::vector<std::string> Names() const override {
    std::vector<std::string> names;
    for (const auto& [word, value] : words_) names.push_back(word);
    return names;
  }

 private:
  Words words_;
};

/// on or off. YAML files and ROS parameters may turn these words into true and false, which are
/// accepted, too.
class Switch : public ValueOf<bool> {
 public:
  explicit Switch(bool value) : ValueOf(value) {}
  Switch& operator=(bool value) {
    value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override { return value_ ? "on" : "off"; }
  std::string Expected() const override { return "on or off"; }
  std::vector<std::string> Names() const override { return {"on", "off"}; }
};

/// --name, or --name=false; off unless given.
class Flag : public ValueOf<bool> {
 public:
  explicit Flag(bool value = false) : ValueOf(value) {}
  Flag& operator=(bool value) {
    value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override { return value_ ? "true" : "false"; }
  std::string Expected() const override { return "true or false"; }
  std::vector<std::string> Names() const override { return {"true", "false"}; }
  JsonKind json_kind() const override { return JsonKind::kTruth; }
};

/// Which numbers are accepted, both ends included by default.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::string unit = {};
  bool is_least_excluded = false;  // "more than 0, at most 60 s"
  std::string meaning = {};        // of single values: "0: as fast as possible"
};

/// A finite number.
class Number : public ValueOf<double> {
 public:
  Number(double value, Range range) : ValueOf(value), range_(std::move(range)) {}
  Number& operator=(double value) {
    value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
  JsonKind json_kind() const override { return JsonKind::kNumber; }

 private:
  Range range_;
};

/// A whole number.
class Whole : public ValueOf<long> {
 public:
  Whole(long value, Range range) : ValueOf(value), range_(std::move(range)) {}
  Whole& operator=(long value) {
    value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override { return std::to_string(value_); }
  std::string Expected() const override;
  JsonKind json_kind() const override { return JsonKind::kNumber; }

 private:
  Range range_;
};

struct PixelSize {
  int width = 0, height = 0;
  bool operator==(const PixelSize& other) const {
    return width == other.width && height == other.height;
  }
};

/// WIDTHxHEIGHT, px.
class Size : public ValueOf<PixelSize> {
 public:
  static constexpr int kMin = kMinPictureSide, kMax = kMaxPictureSide;

  explicit Size(PixelSize value) : ValueOf(value) {}
  Size& operator=(PixelSize value) {
    value_ = value;
    return *this;
  }

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
};

/// A value that need not be given. `*value` only where it is.
template <class V>
class Optional : public Value {
 public:
  explicit Optional(V inner) : inner_(std::move(inner)) {}
  template <class T>
  Optional& operator=(T value) {
    inner_ = std::move(value);
    is_given_ = true;
    return *this;
  }

  explicit operator bool() const { return is_given_; }
  const auto& operator*() const { return *inner_; }
  template <class T>
  auto value_or(T other) const {
    return is_given_ ? *inner_ : other;
  }

  void Parse(const std::string& text) override {
    inner_.Parse(text);
    is_given_ = true;
  }
  std::string ToText() const override { return is_given_ ? inner_.ToText() : ""; }
  std::string Expected() const override { return inner_.Expected(); }
  bool IsGiven() const override { return is_given_; }
  std::vector<std::string> Names() const override { return inner_.Names(); }
  void SetFolder(const std::filesystem::path& folder) override { inner_.SetFolder(folder); }
  std::vector<std::filesystem::path> Files() const override {
    return is_given_ ? inner_.Files() : std::vector<std::filesystem::path>();
  }
  JsonKind json_kind() const override { return inner_.json_kind(); }
  std::vector<FormerWord> former_words() const override { return inner_.former_words(); }

 private:
  V inner_;
  bool is_given_ = false;
};

/// Items as SplitItems() finds them, each read by a function of its own.
template <class T>
class List : public ValueOf<std::vector<T>> {
 public:
  using ParseItem = std::function<T(const std::string& item)>;  // @throws BadValue

  List(std::string expected, std::size_t most, ParseItem parse, std::vector<FormerWord> former = {},
       std::vector<std::string> names = {})
      : ValueOf<std::vector<T>>({}),
        expected_(std::move(expected)),
        most_(most),
        parse_(std::move(parse)),
        former_(std::move(former)),
        names_(std::move(names)) {}

  void Parse(const std::string& text) override {
    std::vector<T> items;
    std::vector<FormerWord> found;
    std::string text_now;
    for (std::string item : SplitItems(text)) {
      if (items.size() == most_)
        throw BadValue("expected at most " + std::to_string(most_) + " of " + expected_);
      if (const FormerWord* const word = FindFormer(former_, item)) {
        found.push_back(*word);
        item = word->current;
      }
      items.push_back(parse_(item));
      text_now += (text_now.empty() ? "" : ",") + item;
    }
    this->value_ = std::move(items);
    text_ = found.empty() ? text : text_now;
    found_ = std::move(found);
  }
  std::string ToText() const override { return text_; }
  std::string Expected() const override { return expected_; }
  std::vector<std::string> Names() const override { return names_; }
  std::vector<FormerWord> former_words() const override { return found_; }

 private:
  std::string expected_;
  std::size_t most_;
  ParseItem parse_;
  std::vector<FormerWord> former_, found_;
  std::vector<std::string> names_;  // of items, for the nearest one to a wrong text
  std::string text_;
};

}  // namespace kinescope::options
