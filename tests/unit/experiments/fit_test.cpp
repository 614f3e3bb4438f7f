#include "experiments/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/judgement.hpp"

namespace supple::experiments::fit_test {

Points points_of(double (*function)(double)) {
  Points points;
  for (const double x : {1e2, 1e3, 1e4, 1e5, 1e6}) points.emplace_back(x, function(x));
  return points;
}

double n_log_n(double n) {
  return n * std::log(n);
}

TEST(FitPowerLaw, FindsAPower) {
  const PowerLaw fit = fit_power_law(points_of([](double x) { return 3 * std::pow(x, 1.5); }));
  EXPECT_NEAR(fit.exponent, 1.5, 1e-12);
  EXPECT_NEAR(fit.factor, 3, 1e-9);
  EXPECT_NEAR(fit.standard_error, 0, 1e-9);
  EXPECT_EQ(fit.points, 5u);
}

TEST(FitPowerLaw, HasTheStandardErrorOfLeastSquares) {
  // ln y is 0, 2, 1 at ln x = 0, 1, 2: slope 1/2, residuals -1/2, 1, -1/2, error √(3/2 / 1 / 2).
  const double e = std::exp(1.0);
  const PowerLaw fit = fit_power_law({{1, 1}, {e, e * e}, {e * e, e}});
  EXPECT_NEAR(fit.exponent, 0.5, 1e-12);
  EXPECT_NEAR(fit.standard_error, std::sqrt(0.75), 1e-12);
}

TEST(FitPowerLaw, LeavesOutWhatHasNoLogarithm) {
  const PowerLaw fit = fit_power_law({{1, 0}, {0, 5}, {1, 2}, {2, 4}, {4, 8}});
  EXPECT_NEAR(fit.exponent, 1, 1e-12);
  EXPECT_EQ(fit.points, 3u);
}

TEST(FitPowerLaw, SaysWhenThereAreTooFewPoints) {
  EXPECT_TRUE(std::isnan(fit_power_law({}).exponent));
  EXPECT_TRUE(std::isnan(fit_power_law({{1, 1}}).exponent));
  EXPECT_TRUE(std::isnan(fit_power_law({{2, 1}, {2, 3}}).exponent));
  const PowerLaw two = fit_power_law({{1, 1}, {10, 100}});
  EXPECT_NEAR(two.exponent, 2, 1e-12);
  EXPECT_TRUE(std::isnan(two.standard_error));
}

TEST(FitPowerLaw, ExponentOfAFormulaIsOverTheSameSizes) {
  const Points points = points_of(n_log_n);
  EXPECT_NEAR(exponent_of(n_log_n, points), fit_power_law(points).exponent, 1e-12);
  EXPECT_GT(exponent_of(n_log_n, points), 1.05);
  EXPECT_LT(exponent_of(n_log_n, points), 1.2);
}

Growth growth(const char* unit, double (*measured)(double), double (*formula)(double)) {
  return {"quantity", unit, points_of(measured), "formula", formula};
}

double line(double n) {
  return n;
}
double square(double n) {
  return n * n;
}

TEST(JudgeBounds, ABoundIsFromAbove) {
  EXPECT_EQ(judge_bounds("", "", "", {growth("tests", line, square)}).verdict, Verdict::holds);
  EXPECT_EQ(judge_bounds("", "", "", {growth("tests", square, square)}).verdict, Verdict::holds);
  EXPECT_EQ(judge_bounds("", "", "", {growth("tests", square, line)}).verdict, Verdict::does_not_hold);
  EXPECT_EQ(judge_bounds("", "", "", {growth("tests", n_log_n, n_log_n)}).verdict, Verdict::holds);
}

TEST(JudgeBounds, TestsDecideAndTimesStandBeside) {
  const Claim claim = judge_bounds("", "", "", {growth("time", square, line), growth("tests", line, line)});
  EXPECT_EQ(claim.verdict, Verdict::holds);
  EXPECT_NE(claim.reason.find("2.00"), std::string::npos);
  EXPECT_EQ(judge_bounds("", "", "", {growth("time", line, line), growth("tests", square, line)}).verdict,
            Verdict::does_not_hold);
}

TEST(JudgeBounds, ATimeALittleAboveSaysNothing) {
  const auto a_little = [](double n) { return std::pow(n, 1.2); };
  EXPECT_EQ(judge_bounds("", "", "", {growth("time", a_little, line)}).verdict, Verdict::cannot_tell);
  EXPECT_EQ(judge_bounds("", "", "", {growth("tests", a_little, line)}).verdict, Verdict::does_not_hold);
  EXPECT_EQ(judge_bounds("", "", "", {growth("time", square, line)}).verdict, Verdict::does_not_hold);
}

TEST(JudgeBounds, TheNumberIsTheExponentWithTheGreatestExcess) {
  const Claim claim =
      judge_bounds("", "", "", {growth("tests", line, square), growth("tests", square, line)});
  EXPECT_NEAR(claim.number->mean, 2, 1e-9);
  EXPECT_NE(claim.quantity.find("1.00"), std::string::npos) << claim.quantity;
}

TEST(Estimates, RatioOfSumsHasTheErrorOfTheJackknife) {
  const std::vector<double> a{2, 4, 9}, b{1, 2, 3};
  const Estimate ratio = ratio_of_sums(a, b);
  EXPECT_DOUBLE_EQ(ratio.mean, 15.0 / 6);
  // Without each pair: 13/5, 11/4 and 6/3.
  const std::vector<double> without{2.6, 2.75, 2};
  const double mean = (2.6 + 2.75 + 2) / 3;
  double squares = 0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  EXPECT_DOUBLE_EQ(ratio.error, std::sqrt(2.0 / 3 * squares));
  EXPECT_TRUE(std::isnan(ratio_of_sums(a, std::vector<double>{0, 0, 0}).mean));
  EXPECT_TRUE(std::isnan(ratio_of_sums(std::vector<double>{1}, std::vector<double>{1}).error));
}

TEST(Estimates, TheMedianIgnoresOutliers) {
  const Estimate median = median_of(std::vector<double>{1.0, 1.1, 0.9, 1.05, 40});
  EXPECT_DOUBLE_EQ(median.mean, 1.05);
  EXPECT_LT(median.error, 0.1);
  EXPECT_DOUBLE_EQ(median_of(std::vector<double>{1, 3}).mean, 2);
  EXPECT_TRUE(std::isnan(median_of(std::vector<double>{1}).error));
  EXPECT_TRUE(std::isnan(median_of({}).mean));
}

TEST(Estimates, VerdictsNeedTwoStandardErrors) {
  EXPECT_EQ(above({2, 0.4}, 1), Verdict::holds);
  EXPECT_EQ(above({2, 0.6}, 1), Verdict::cannot_tell);
  EXPECT_EQ(above({0, 0.4}, 1), Verdict::does_not_hold);
  EXPECT_EQ(within({1, 0.2}, 0.5, 2), Verdict::holds);
  EXPECT_EQ(within({1.9, 0.2}, 0.5, 2), Verdict::cannot_tell);
  EXPECT_EQ(within({3, 0.2}, 0.5, 2), Verdict::does_not_hold);
  const Estimate ratio = quotient({6, 0.6}, {2, 0.1});
  EXPECT_DOUBLE_EQ(ratio.mean, 3);
  EXPECT_NEAR(ratio.error, 3 * std::hypot(0.1, 0.05), 1e-12);
}

TEST(JudgeBounds, TwoSizesAreTooFew) {
  Growth two = growth("tests", line, line);
  two.points.resize(2);
  const Claim claim = judge_bounds("", "", "", {two});
  EXPECT_EQ(claim.verdict, Verdict::cannot_tell);
  EXPECT_NE(claim.reason.find("2 sizes"), std::string::npos);
}

TEST(Estimate, HasTheStandardErrorOfTheMean) {
  const Estimate estimate = estimate_of(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(estimate.mean, 2.5);
  EXPECT_DOUBLE_EQ(estimate.error, std::sqrt(5.0 / 3 / 4));
  EXPECT_TRUE(std::isnan(estimate_of(std::vector<double>{1}).error));
  EXPECT_TRUE(std::isnan(estimate_of({}).mean));
}

}  // namespace supple::experiments::fit_test
