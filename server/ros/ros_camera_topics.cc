#include "server/ros/ros_camera_topics.h"

#include <image_transport/image_transport.h>
#include <ros/publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <spdlog/spdlog.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <optional>
#include <utility>

#include "core/system/starts_with.h"
#include "server/ros/view_messages.h"

namespace kinescope::ros_bridge {
namespace {

constexpr char kImage[] = "view/image_raw";
constexpr char kCameraInfo[] = "view/camera_info";
// A subscriber slower than the frame rate gets the newest pictures.
constexpr std::uint32_t kViewQueue = 2;

// A task for the thread that calls the queue.
class Errand : public ros::CallbackInterface {
 public:
  explicit Errand(std::function<void()> run) : run_(std::move(run)) {}
  CallResult call() override {
    run_();
    return Success;
  }

 private:
  const std::function<void()> run_;
};

}  // namespace

struct RosCameraTopics::Parts {
  std::string reference_frame, optical_frame;
  std::string base;  // resolved: "/kinescope/view/"
  OnListeners on_listeners;

  // One of them, depending on whether image_transport works.
  std::optional<image_transport::CameraPublisher> camera;
  ros::Publisher plain_image, plain_info;
  ros::Publisher tf;

  // Subscribers that waited for the topics connect while these are still being advertised: they
  // must not be counted yet, and all are counted when this is set.
  std::atomic<bool> is_ready{false};
  std::atomic<bool> frame_is_due{true};  // a new subscriber does not have it
  // Used by the rendering thread only.
  boost::shared_ptr<sensor_msgs::Image> image;
  boost::shared_ptr<sensor_msgs::CameraInfo> info;
  tf2_msgs::TFMessage frame;

  int CountListeners() const {
    if (camera) return static_cast<int>(camera->getNumSubscribers());
    return static_cast<int>(
        std::max(plain_image.getNumSubscribers(), plain_info.getNumSubscribers()));
  }
  void OnConnection(bool is_new) {
    if (is_new) frame_is_due = true;
    if (!is_ready) return;
    on_listeners(CountListeners());
  }

  void AdvertiseCamera(const ros::NodeHandle& node);
  void AdvertisePlain(ros::NodeHandle& node);
};

void RosCameraTopics::Parts::AdvertiseCamera(const ros::NodeHandle& node) {
  image_transport::ImageTransport transport(node);
  const image_transport::SubscriberStatusCallback image_come = [this](const auto&) {
    OnConnection(true);
  };
  const image_transport::SubscriberStatusCallback image_go = [this](const auto&) {
    OnConnection(false);
  };
  const ros::SubscriberStatusCallback info_come = [this](const auto&) { OnConnection(true); };
  const ros::SubscriberStatusCallback info_go = [this](const auto&) { OnConnection(false); };
  camera = transport.advertiseCamera(kImage, kViewQueue, image_come, image_go, info_come, info_go);
}

void RosCameraTopics::Parts::AdvertisePlain(ros::NodeHandle& node) {
  const ros::SubscriberStatusCallback come = [this](const auto&) { OnConnection(true); };
  const ros::SubscriberStatusCallback go = [this](const auto&) { OnConnection(false); };
  plain_image = node.advertise<sensor_msgs::Image>(kImage, kViewQueue, come, go);
  plain_info = node.advertise<sensor_msgs::CameraInfo>(kCameraInfo, kViewQueue, come, go);
}

RosCameraTopics::RosCameraTopics(const ros::NodeHandle& node, ros::CallbackQueue& queue,
                                 std::string reference_frame, OnListeners on_listeners)
    : parts_(std::make_unique<Parts>()) {
  ros::NodeHandle own(node);
  own.setCallbackQueue(&queue);
  parts_->base = own.resolveName("view") + "/";
  parts_->reference_frame = std::move(reference_frame);
  parts_->optical_frame = OpticalFrame(own.resolveName("view"));
  parts_->on_listeners = std::move(on_listeners);
  parts_->tf = own.advertise<tf2_msgs::TFMessage>("/tf", kViewQueue);
  try {
    parts_->AdvertiseCamera(own);
  } catch (const std::exception& problem) {  // of pluginlib and image_transport
    spdlog::warn(
        "{}image_raw is published uncompressed only, because image_transport found no plugins ({})",
        parts_->base, problem.what());
    parts_->camera.reset();
    parts_->AdvertisePlain(own);
  }
  parts_->is_ready = true;
  queue.addCallback(
      boost::make_shared<Errand>([parts = parts_.get()] { parts->OnConnection(true); }));
}

RosCameraTopics::~RosCameraTopics() = default;

std::map<std::string, std::string> RosCameraTopics::TypesByTopic() const {
  std::map<std::string, std::string> types;
  ros::V_string topics;
  ros::this_node::getAdvertisedTopics(topics);
  for (const std::string& topic : topics) {
    if (topic != "/tf" && !StartsWith(topic, parts_->base)) continue;
    const auto publication = ros::TopicManager::instance()->lookupPublication(topic);
    if (publication) types[topic] = publication->getDataType();
  }
  return types;
}

void RosCameraTopics::Publish(const RosImage& picture) {
  Parts& parts = *parts_;
  // Frames with an equal time are known, and tf2 warns when it receives them again.
  const bool frame_is_due = parts.frame_is_due.exchange(false);
  parts.frame.transforms.resize(1);
  const ros::Time before = parts.frame.transforms[0].header.stamp;
  FillCameraFrame(picture, parts.reference_frame, parts.optical_frame, parts.frame.transforms[0]);
  if (frame_is_due || parts.frame.transforms[0].header.stamp != before) {
    parts.tf.publish(parts.frame);
  }
  // A subscriber in this process may still hold the last message.
  if (!parts.image || !parts.image.unique()) parts.image = boost::make_shared<sensor_msgs::Image>();
  if (!parts.info || !parts.info.unique()) {
    parts.info = boost::make_shared<sensor_msgs::CameraInfo>();
  }
  FillImage(picture, parts.optical_frame, *parts.image);
  FillCameraInfo(picture, parts.optical_frame, *parts.info);
  if (parts.camera) {
    parts.camera->publish(parts.image, parts.info);
  } else {
    parts.plain_image.publish(parts.image);
    parts.plain_info.publish(parts.info);
  }
}

}  // namespace kinescope::ros_bridge
