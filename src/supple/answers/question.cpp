#include "answers/question.hpp"

#include "answers/penetration/manifold_methods.hpp"
#include "core/error.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

Question question_of(const DetectRequest& request, const SceneOptions& options) {
  if (request.impact) check(*request.impact, "DetectRequest::impact");
  Question question{.contacts = with_included(request.contacts.value_or(options.contacts)),
                    .impact = {request.impact.value_or(options.impact),
                               request.element_kinds.value_or(options.element_kinds),
                               request.continuous_listing.value_or(options.continuous_listing)},
                    .proximity_listing = request.proximity_listing.value_or(options.proximity_listing),
                    .contact_points = options.contact_points,
                    .colliding_vertices = options.comparison.colliding_vertices,
                    .lazy_refit = options.comparison.lazy_refit,
                    .manifolds = request.manifolds.value_or(options.manifolds),
                    .curves = request.curves.value_or(options.curves)};
  if (request.manifolds.value_or(false) && !question.has_penetration() &&
      !question.searches(ContactKinds::proximity))
    fail("detect: manifolds are made from penetration or proximity; request one of these contacts");
  if (request.curves.value_or(false) && !question.has_penetration())
    fail("detect: curves belong to penetration; request it, too");
  question.curves = (question.curves || question.manifolds) && question.has_penetration();
  if (question.has_penetration() && request.max_contacts != DetectRequest{}.max_contacts)
    fail("detect: penetration needs all intersections; request it without max_contacts");
  if (question.curves) manifold_methods(question.manifolds ? "manifolds" : "curves");
  return question;
}

}  // namespace supple
