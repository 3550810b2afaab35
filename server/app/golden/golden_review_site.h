/// The page of a review and what it asks for, as requests and answers.
///
/// A run may come from a CI server, so from a stranger, and its `report.html` could have scripts
/// that accept pictures by themselves. That file is not read: the page is made from `run.json`
/// and the pictures, by the writer of the report, which escapes every text. It is served with a
/// Content-Security-Policy that runs no script and applies no style but ours (by a nonce), loads
/// nothing from elsewhere, and sends nothing elsewhere.
///
///     GET  /            the page, made once: it shows the pictures as they were at the start
///     GET  /decisions   {"decisions": {"bend": "accepted", ...}}; those that are decided
///     POST /decisions   {"case": "bend", "order": "accept"}, or "reject", "later", "undo"; the
///                       decisions, with status 409 also "error": why it was not done
///     POST /end         ends the review, if each case is decided
///
/// One thread.
#pragma once

#include <string>

#include "server/app/golden/golden_review.h"
#include "server/http/local_server.h"

namespace kinescope::app {

class ReviewSite {
 public:
  /// `review` is borrowed. `token`: that the page sends with its requests.
  ReviewSite(GoldenReview& review, const std::string& token);

  /// @throws std::exception if the cases cannot be read any more.
  http::Answer Handle(const http::LocalRequest& request);
  /// The person has ended the review on the page.
  bool has_ended() const { return has_ended_; }

 private:
  http::Answer Page() const;
  http::Answer CarryOut(const std::string& body);
  http::Answer End();
  http::Answer Decisions(int status = 200, const std::string& error = "") const;

  GoldenReview& review_;
  const std::string nonce_;
  const std::string page_;
  bool has_ended_ = false;
};

}  // namespace kinescope::app
