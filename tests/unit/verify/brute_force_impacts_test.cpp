// Checks that `verify` of continuous contacts finds every fault inserted into a correct result.

#include "verify/brute_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/soups.hpp"

namespace supple::brute_force_impacts_test {

using Fault = ContinuousDifference::Fault;

struct Step {
  PlainObject a, b;
  std::vector<ContinuousContact> reported;
  std::vector<TouchingElements> truth;

  /// Two crumpled sheets pass through each other.
  explicit Step(double separation) {
    const TriangleMesh sheet = crumpled_sheet(6, 6, 0.05, 1), other = crumpled_sheet(6, 6, 0.05, 2);
    a = {sheet.positions, sheet.positions, sheet.triangles};
    b = {other.positions, other.positions, other.triangles};
    for (Vec3d& p : b.start) p.y += 0.4;
    for (Vec3d& p : b.end) p.y -= 0.3;
    SceneOptions options;
    options.contacts = ContactKinds::continuous;
    options.impact.min_separation = separation;
    Scene scene(options);
    for (const PlainObject* object : {&a, &b}) {
      TriangleMesh mesh;
      mesh.positions = object->start;
      mesh.triangles = object->triangles;
      const ObjectId id = scene.add(mesh);
      scene.set_motion(id, object->start, object->end);
    }
    const auto contacts = scene.detect().continuous_contacts;
    reported.assign(contacts.begin(), contacts.end());
    truth = truth_at(separation);
  }

  std::vector<TouchingElements> truth_at(double separation) const {
    return find_impacts_by_brute_force(a, b, false, {.min_separation = separation}, ElementKinds::all,
                                       Parallel(1))
        .touching;
  }
  std::vector<Fault> faults_of(const std::vector<ContinuousContact>& contacts) const {
    std::vector<ContinuousDifference> differences;
    compare_impacts({}, contacts, truth, ContinuousListing::all, {}, differences);
    std::vector<Fault> faults;
    for (const ContinuousDifference& difference : differences) faults.push_back(difference.fault);
    return faults;
  }
};

struct BruteForceImpacts : testing::TestWithParam<double> {};

TEST_P(BruteForceImpacts, FindsEachFaultInAResult) {
  const Step step(GetParam());
  ASSERT_GT(step.reported.size(), 20u);
  EXPECT_EQ(step.faults_of(step.reported), std::vector<Fault>{});
  int shifted = 0;
  for (std::size_t i = 0; i < step.reported.size(); ++i) {
    const auto changed = [&](auto change) {
      std::vector<ContinuousContact> contacts = step.reported;
      change(contacts[i]);
      return step.faults_of(contacts);
    };
    EXPECT_EQ(changed([](ContinuousContact& c) { c.toi += 0x1p-29; }), std::vector{Fault::late}) << i;
    if (step.reported[i].toi > 0x1p-28) {
      EXPECT_EQ(changed([](ContinuousContact& c) { c.toi -= 0x1p-29; }), std::vector{Fault::early}) << i;
      ++shifted;
    }
    const auto place = static_cast<std::ptrdiff_t>(i);
    std::vector<ContinuousContact> contacts = step.reported;
    contacts.insert(contacts.begin() + place, contacts[i]);
    EXPECT_EQ(step.faults_of(contacts), std::vector{Fault::added}) << i;
    contacts = step.reported;
    contacts.erase(contacts.begin() + place);
    EXPECT_EQ(step.faults_of(contacts), std::vector{Fault::missed}) << i;
  }
  EXPECT_GT(shifted, 20);
}

TEST_P(BruteForceImpacts, KnowsTheSeparation) {
  if (GetParam() == 0) GTEST_SKIP() << "a separation of 0 has no smaller one";
  const Step step(GetParam());
  std::vector<ContinuousDifference> differences;
  compare_impacts({}, step.reported, step.truth_at(GetParam() * (1 - 0x1p-20)), ContinuousListing::all, {},
                  differences);
  EXPECT_FALSE(differences.empty()) << "all contacts with a slightly smaller separation are later";
  differences.clear();
  compare_impacts({}, step.reported, step.truth_at(GetParam() * (1 + 0x1p-20)), ContinuousListing::all, {},
                  differences);
  EXPECT_FALSE(differences.empty()) << "all contacts with a slightly larger separation are earlier";
}

INSTANTIATE_TEST_SUITE_P(Separations, BruteForceImpacts, testing::Values(0.0, 0.001, 0.05));

}  // namespace supple::brute_force_impacts_test
