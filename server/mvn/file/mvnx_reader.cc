#include "server/mvn/file/mvnx_reader.h"

#include <expat.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/system/errors.h"
#include "server/mvn/file/mvnx_elements.h"
#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr int kMvnxChunkBytes = 64 * 1024;
constexpr std::size_t kLongestText = 1 << 18;  // a list of a body with two gloves has 8 kB
constexpr std::int64_t kLongestTag = 1 << 20;  // expat keeps a tag in memory until it is complete
constexpr std::size_t kDeepest = 32;
constexpr std::size_t kMaxMvnxSegments = 128;
constexpr std::size_t kMaxJoints = 256;
constexpr std::size_t kMaxContacts = 64;
constexpr double kHighestRate = 10000;

// The value of an attribute; nullptr if it is absent.
const char* Find(const char** attributes, const char* name) {
  for (; attributes[0] != nullptr; attributes += 2) {
    if (std::strcmp(attributes[0], name) == 0) return attributes[1];
  }
  return nullptr;
}

std::string FindText(const char** attributes, const char* name) {
  const char* const value = Find(attributes, name);
  return value == nullptr ? std::string() : CleanText(value, kLongestName);
}

std::optional<std::int64_t> FindInteger(const char** attributes, const char* name) {
  const char* const value = Find(attributes, name);
  return value == nullptr ? std::nullopt : ParseInteger(value);
}

}  // namespace

// Expat calls back while it reads. A callback cannot throw through C code, so it records the error
// and stops the parser; Run() throws.
class MvnxReader::Parser {
 public:
  Parser(InputFile file, std::string name)
      : file_(std::move(file)),
        name_(std::move(name)),
        expat_(XML_ParserCreate(nullptr), &XML_ParserFree) {
    XML_SetUserData(expat_.get(), this);
    XML_SetElementHandler(
        expat_.get(),
        [](void* self, const char* element, const char** attributes) {
          static_cast<Parser*>(self)->OnStart(element, attributes);
        },
        [](void* self, const char*) { static_cast<Parser*>(self)->OnEnd(); });
    XML_SetCharacterDataHandler(expat_.get(), [](void* self, const char* text, int size) {
      static_cast<Parser*>(self)->OnText({text, static_cast<std::size_t>(size)});
    });
    XML_SetStartDoctypeDeclHandler(
        expat_.get(), [](void* self, const char*, const char*, const char*, int) {
          static_cast<Parser*>(self)->Fail(
              "DOCTYPE is not supported, because it can include other files; remove it");
        });
  }

  /// Reads on until the header or a frame is complete; false at the end of the file.
  bool Run() {
    stopped_ = false;
    while (!stopped_) {
      if (finished_) return false;
      const XML_Status status = suspended_ ? XML_ResumeParser(expat_.get()) : Feed();
      suspended_ = status == XML_STATUS_SUSPENDED;
      if (status == XML_STATUS_ERROR) Throw();
      if (status == XML_STATUS_OK && at_end_) finished_ = true;
      if (bytes_read_ - XML_GetCurrentByteIndex(expat_.get()) > kLongestTag + kMvnxChunkBytes) {
        Refuse("a tag is longer than a megabyte");
      }
    }
    return true;
  }

  [[noreturn]] void Refuse(const std::string& reason) const {
    throw SourceError(name_ + ":" + std::to_string(XML_GetCurrentLineNumber(expat_.get())) + ": " +
                      reason);
  }

  const MvnxHeader& header() const { return header_; }
  bool has_header() const { return has_header_; }
  MvnxFrame& frame() { return frame_; }
  std::uint64_t bytes_read() const { return static_cast<std::uint64_t>(bytes_read_); }

 private:
  XML_Status Feed() {
    void* const buffer = XML_GetBuffer(expat_.get(), kMvnxChunkBytes);
    if (buffer == nullptr) Refuse("not enough memory");
    const std::size_t size = std::fread(buffer, 1, kMvnxChunkBytes, file_.get());
    if (std::ferror(file_.get()) != 0) {
      Refuse("the file is truncated here, after " + std::to_string(frames_) +
             " frames: " + file_.failure() + "; copy or export it again");
    }
    bytes_read_ += static_cast<std::int64_t>(size);
    at_end_ = size < static_cast<std::size_t>(kMvnxChunkBytes);
    return XML_ParseBuffer(expat_.get(), static_cast<int>(size), at_end_ ? 1 : 0);
  }

  [[noreturn]] void Throw() const {
    if (!failure_.empty()) Refuse(failure_);
    const XML_Error error = XML_GetErrorCode(expat_.get());
    const std::string message = XML_ErrorString(error);
    if (bytes_read_ == 0) Refuse("the file is empty");
    if (!seen_root_) Refuse("not XML, so not MVNX (" + message + ")");
    if (at_end_ && (error == XML_ERROR_NO_ELEMENTS || error == XML_ERROR_UNCLOSED_TOKEN ||
                    error == XML_ERROR_PARTIAL_CHAR)) {
      Refuse("the file is truncated here, after " + std::to_string(frames_) +
             " frames; copy or export it again");
    }
    Refuse("invalid XML (" + message + ")");
  }

  void Fail(std::string reason) {
    if (failure_.empty()) failure_ = std::move(reason);
    XML_StopParser(expat_.get(), XML_FALSE);
  }

  // Run() returns after expat has finished the current tag.
  void Pause() {
    stopped_ = true;
    XML_StopParser(expat_.get(), XML_TRUE);
  }

  void OnStart(const char* name, const char** attributes) {
    if (!failure_.empty()) return;
    if (path_.size() >= kDeepest) return Fail("elements are nested too deeply for MVNX");
    MvnxList list = MvnxList::kOrientation;
    const Element parent = path_.empty() ? Element::kDocument : path_.back();
    Element element = FindElement(parent, name, list);
    if (element == Element::kList && IsMeaningUnknown(list)) element = Element::kOther;
    path_.push_back(element);
    text_.clear();
    if (parent == Element::kDocument) {
      seen_root_ = true;
      if (element != Element::kMvnx) {
        return Fail("XML, but not MVNX: it begins with <" + CleanText(name, kLongestName) + ">");
      }
    }
    switch (element) {
      case Element::kMvnx: return OnMvnx(attributes);
      case Element::kSubject: return OnSubject(attributes);
      case Element::kSegment: return OnSegment(attributes);
      case Element::kPoint: point_label_ = FindText(attributes, "label"); return;
      case Element::kJoint: return OnJoint(attributes);
      case Element::kSensor: return OnSensor(attributes);
      case Element::kContact: return OnContact(attributes);
      case Element::kFrames: return OnFrames();
      case Element::kFrame: return OnFrame(attributes);
      case Element::kList: list_ = list; return;
      default: return;
    }
  }

  // The header does not say what its numbers belong to.
  bool IsMeaningUnknown(MvnxList list) const {
    if (IsOfSensors(list)) return header_.sensors.empty();
    return list == MvnxList::kFootContacts && header_.foot_contacts.empty();
  }

  void OnMvnx(const char** attributes) {
    const std::string version = FindText(attributes, "version");
    const auto number = ParseInteger(version.substr(0, version.find('.')));
    if (number != 3 && number != 4) {
      return Fail("unsupported MVNX version '" + version +
                  "'; expected 3 (MVN Studio 3 and 4) or 4 (since MVN 2018). Open the recording in "
                  "a newer MVN and export it again");
    }
    header_.version = static_cast<int>(*number);
  }

  void OnSubject(const char** attributes) {
    if (seen_subject_) return Fail("a second <subject>; MVN writes one file per person");
    seen_subject_ = true;
    header_.subject = FindText(attributes, "label");
    header_.color_rgb = ParseColor(FindText(attributes, "torsoColor"));
    segment_count_ = FindInteger(attributes, "segmentCount");
    const std::string rate = FindText(attributes, "frameRate");
    std::vector<double> numbers;
    if (!ParseNumbers(rate, numbers).empty() || numbers.size() != 1 || numbers[0] <= 0 ||
        numbers[0] > kHighestRate) {
      return Fail("frameRate is '" + rate +
                  "'; expected more than 0, at most 10000 frames per second");
    }
    header_.rate_hz = numbers[0];
  }

  void OnSegment(const char** attributes) {
    if (header_.segments.size() >= kMaxMvnxSegments) return Fail("too many segments");
    header_.segments.push_back(urdf::FindSegment(FindText(attributes, "label")));
  }

  void OnJoint(const char** attributes) {
    if (header_.joints.size() >= kMaxJoints) return Fail("too many joints");
    header_.joints.push_back(urdf::FindJoint(FindText(attributes, "label")));
  }

  void OnSensor(const char** attributes) {
    const std::string label = FindText(attributes, "label");
    const auto segment = urdf::FindSegment(label);
    const auto& sensors = header_.sensors;
    if (sensors.size() >= kMaxMvnxSegments) return Fail("too many sensors");
    if (segment && std::find(sensors.begin(), sensors.end(), segment) != sensors.end()) {
      return Fail("sensor " + label + " is listed twice");
    }
    header_.sensors.push_back(segment);
  }

  void OnContact(const char** attributes) {
    if (header_.foot_contacts.size() >= kMaxContacts) return Fail("too many foot contacts");
    header_.foot_contacts.push_back(FindText(attributes, "label"));
  }

  void OnFrames() {
    if (has_header_) return Fail("a second <frames>");
    const std::size_t count = header_.segments.size();
    if (segment_count_ && *segment_count_ != static_cast<std::int64_t>(count)) {
      return Fail("segmentCount is " + std::to_string(*segment_count_) + ", but " +
                  std::to_string(count) + " segments are listed");
    }
    std::array<int, urdf::kSegmentCount> times{};
    for (const auto& segment : header_.segments) {
      if (segment) ++times[static_cast<std::size_t>(*segment)];
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] == 1) continue;
      return Fail("segment " + std::string(urdf::kSegments[i].mvn_name) + " is listed " +
                  std::to_string(times[i]) + " times; expected each of the 23 once");
    }
    has_header_ = true;
    Pause();
  }

  void OnFrame(const char** attributes) {
    frame_.type = FindText(attributes, "type");
    frame_.index = FindInteger(attributes, "index");
    frame_.unix_millis = FindInteger(attributes, "ms");
    for (auto& list : frame_.lists) list.clear();
  }

  void OnText(std::string_view text) {
    if (!failure_.empty() || path_.empty()) return;
    if (path_.back() != Element::kList && path_.back() != Element::kPointPosition) return;
    if (text_.size() + text.size() > kLongestText) return Fail("a list of numbers is too long");
    text_.append(text);
  }

  void OnEnd() {
    if (!failure_.empty()) return;
    const Element element = path_.back();
    path_.pop_back();
    if (element == Element::kPointPosition) return OnPointEnd();
    if (element == Element::kList) return OnListEnd();
    if (element != Element::kFrame) return;
    ++frames_;
    Pause();
  }

  void OnPointEnd() {
    const std::string wrong = ParseNumbers(text_, numbers_);
    if (!wrong.empty()) return Fail("point " + point_label_ + ": " + wrong);
    if (numbers_.size() != 3) {
      return Fail("point " + point_label_ + " has " + std::to_string(numbers_.size()) +
                  " coordinates; expected 3");
    }
    const auto& segment = header_.segments.back();  // a point is inside its segment
    if (!segment) return;
    if (header_.points.size() >= urdf::kMaxLandmarks) return Fail("too many points");
    const bool is_next = !header_.points.empty() && header_.points.back().segment == *segment;
    header_.points.push_back({*segment,
                              is_next ? header_.points.back().number + 1 : 1,
                              point_label_,
                              {numbers_[0], numbers_[1], numbers_[2]}});
  }

  void OnListEnd() {
    std::vector<double>& numbers = frame_.lists[static_cast<std::size_t>(list_)];
    const std::string wrong = ParseNumbers(text_, numbers);
    if (!wrong.empty()) return Fail(std::string(Name(list_)) + ": " + wrong);
    const bool short_com = list_ == MvnxList::kCenterOfMass && numbers.size() == 3;
    const std::size_t expected = ExpectedSize(list_);
    if (numbers.size() == expected || short_com) return;
    Fail(std::string(Name(list_)) + " has " + std::to_string(numbers.size()) +
         " numbers; expected " + std::to_string(expected) +
         " from the file's segments, joints and sensors");
  }

  std::size_t ExpectedSize(MvnxList list) const {
    switch (list) {
      case MvnxList::kOrientation: return 4 * header_.segments.size();
      case MvnxList::kJointAngle: return 3 * header_.joints.size();
      case MvnxList::kCenterOfMass: return 9;  // or only its position, 3
      case MvnxList::kFootContacts: return header_.foot_contacts.size();
      case MvnxList::kSensorOrientation: return 4 * header_.sensors.size();
      case MvnxList::kSensorFreeAcceleration:
      case MvnxList::kSensorAcceleration:
      case MvnxList::kSensorAngularVelocity:
      case MvnxList::kSensorMagneticField: return 3 * header_.sensors.size();
      default: return 3 * header_.segments.size();
    }
  }

  InputFile file_;
  std::string name_;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> expat_;

  std::vector<Element> path_;  // open elements
  std::string text_;           // of the innermost element, if it is read
  std::vector<double> numbers_;
  std::string point_label_;
  MvnxList list_ = MvnxList::kOrientation;
  std::optional<std::int64_t> segment_count_;  // as announced
  bool seen_root_ = false;
  bool seen_subject_ = false;
  bool has_header_ = false;

  MvnxHeader header_;
  MvnxFrame frame_;
  std::uint64_t frames_ = 0;

  std::int64_t bytes_read_ = 0;
  bool at_end_ = false;
  bool suspended_ = false;
  bool stopped_ = false;
  bool finished_ = false;
  std::string failure_;
};

MvnxReader::MvnxReader(InputFile file, std::string name)
    : parser_(std::make_unique<Parser>(std::move(file), std::move(name))) {
  if (!parser_->Run() || !parser_->has_header()) Refuse("<frames> is missing");
}

MvnxReader::~MvnxReader() = default;

const MvnxHeader& MvnxReader::header() const { return parser_->header(); }

bool MvnxReader::Next(MvnxFrame& frame) {
  if (!parser_->Run()) return false;
  std::swap(frame, parser_->frame());  // so that its lists are reused
  return true;
}

void MvnxReader::Refuse(const std::string& reason) const { parser_->Refuse(reason); }

std::uint64_t MvnxReader::bytes_read() const { return parser_->bytes_read(); }

}  // namespace kinescope::mvn
