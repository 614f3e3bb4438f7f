#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/intersection/coplanar_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "contact/intersection/coplanar_search.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector3-inl.hpp"
#include "supple/continuous.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using Vector = Vector3<Tag>;

HWY_INLINE Doubles set(double value) {
  return hn::Set(Tag(), value);
}
HWY_INLINE Doubles mix(Doubles a, Doubles b, Doubles t) {
  return hn::Add(hn::Mul(hn::Sub(set(1), t), a), hn::Mul(t, b));
}
HWY_INLINE Vector mix(const Vector& a, const Vector& b, Doubles t) {
  return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)};
}
HWY_INLINE Doubles largest_magnitude(const Vector& v) {
  return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

struct Places {
  Vector m, u, w;

  /// Zeros in lanes without a pair.
  HWY_INLINE Places(const MotionBlock& block, std::size_t row, std::size_t first, Mask lanes) {
    const auto load = [&](std::size_t r)
                          HWY_ATTR { return hn::MaskedLoad(lanes, Tag(), block.row(row + r) + first); };
    m = {load(0), load(1), load(2)};
    u = {load(3), load(4), load(5)};
    w = {load(6), load(7), load(8)};
  }
  HWY_INLINE Places(const Places& start, const Places& end, Doubles t)
      : m(mix(start.m, end.m, t)), u(mix(start.u, end.u, t)), w(mix(start.w, end.w, t)) {}
};

/// Bernstein coefficients on some interval.
struct Coefficients {
  Doubles c[4];

  HWY_INLINE void split(Doubles t, Coefficients& before, Coefficients& after) const {
    const Doubles c01 = mix(c[0], c[1], t), c12 = mix(c[1], c[2], t), c23 = mix(c[2], c[3], t);
    const Doubles c012 = mix(c01, c12, t), c123 = mix(c12, c23, t), middle = mix(c012, c123, t);
    before = {{c[0], c01, c012, middle}};
    after = {{middle, c123, c23, c[3]}};
  }
  /// Whether all values are on one side of 0 by more than `error`.
  HWY_INLINE Mask one_sign(Doubles error) const {
    const Doubles least = hn::Min(hn::Min(c[0], c[1]), hn::Min(c[2], c[3]));
    const Doubles most = hn::Max(hn::Max(c[0], c[1]), hn::Max(c[2], c[3]));
    return hn::Gt(hn::Max(least, hn::Neg(most)), error);
  }
};

HWY_INLINE Coefficients select(Mask mask, const Coefficients& yes, const Coefficients& no) {
  return {{hn::IfThenElse(mask, yes.c[0], no.c[0]), hn::IfThenElse(mask, yes.c[1], no.c[1]),
           hn::IfThenElse(mask, yes.c[2], no.c[2]), hn::IfThenElse(mask, yes.c[3], no.c[3])}};
}

/// Proves one sign of the `wanted` lanes by halving up to `halvings` times.
template <int halvings>
HWY_NOINLINE Mask part_has_one_sign(const Coefficients& part, Doubles error, Mask wanted) {
  const Mask proven = part.one_sign(error);
  if constexpr (halvings > 0) {
    const Mask ends_are_clear = hn::And(hn::Gt(hn::Abs(part.c[0]), error), hn::Gt(hn::Abs(part.c[3]), error));
    const Mask open = hn::And(hn::AndNot(proven, wanted), ends_are_clear);
    if (!hn::AllFalse(Tag(), open)) {
      Coefficients before, after;
      part.split(set(0.5), before, after);
      const Mask first = part_has_one_sign<halvings - 1>(before, error, open);
      const Mask both = hn::And(first, part_has_one_sign<halvings - 1>(after, error, hn::And(open, first)));
      return hn::Or(proven, hn::And(open, both));
    }
  }
  return proven;
}

/// The volume m · (u × w) of the four vertices over the step, a cubic polynomial. Elements can touch only
/// where it is 0.
///
/// `error` bounds the error of all values, relative to the sum of the magnitudes, which bounds every
/// coefficient:
/// - a determinant of differences: 9 · 2^-53 (see plane_filter.hpp);
/// - the sum of three determinants, divided by 3: 12 · 2^-53;
/// - a value, or the coefficients of a part: two times three levels of 3 roundings, 18 · 2^-53 more.
/// That is less than 2^-48 in all. Each of three halvings adds 9 · 2^-53, so 2^-47 covers everything.
///
/// Coordinates up to 2^100, which are `in_range`, do not overflow and lose at most 2^-970 by underflow.
struct Volume {
  Coefficients bernstein;
  Doubles powers[4], error;
  Mask in_range, always_zero;

  HWY_INLINE Volume(const Places& start, const Places& end) {
    const Vector n0 = cross<Tag>(start.u, start.w), n2 = cross<Tag>(end.u, end.w);
    const Vector twice_n1 = add(cross<Tag>(start.u, end.w), cross<Tag>(end.u, start.w));
    const Doubles three = set(3);
    const Doubles c0 = dot<Tag>(start.m, n0), c3 = dot<Tag>(end.m, n2);
    const Doubles c1 = hn::Div(hn::Add(dot<Tag>(end.m, n0), dot<Tag>(start.m, twice_n1)), three);
    const Doubles c2 = hn::Div(hn::Add(dot<Tag>(start.m, n2), dot<Tag>(end.m, twice_n1)), three);
    bernstein = {{c0, c1, c2, c3}};
    powers[0] = c0;
    powers[1] = hn::Mul(three, hn::Sub(c1, c0));
    powers[2] = hn::Mul(three, hn::Add(hn::Sub(c2, hn::Mul(set(2), c1)), c0));
    powers[3] = hn::Sub(hn::Sub(c3, hn::Mul(three, hn::Sub(c2, c1))), c0);
    const Vector m = larger<Tag>(absolute<Tag>(start.m), absolute<Tag>(end.m));
    const Vector u = larger<Tag>(absolute<Tag>(start.u), absolute<Tag>(end.u));
    const Vector w = larger<Tag>(absolute<Tag>(start.w), absolute<Tag>(end.w));
    const Vector minors{hn::Add(hn::Mul(u.y, w.z), hn::Mul(u.z, w.y)),
                        hn::Add(hn::Mul(u.z, w.x), hn::Mul(u.x, w.z)),
                        hn::Add(hn::Mul(u.x, w.y), hn::Mul(u.y, w.x))};
    in_range = hn::Le(largest_magnitude(larger<Tag>(larger<Tag>(m, u), w)), set(0x1p100));
    error = hn::Add(hn::Mul(set(0x1p-47), dot<Tag>(m, minors)), set(0x1p-960));
    const auto is_zero = [&](Doubles p, Doubles q) HWY_ATTR {
      return hn::Or(hn::Eq(p, hn::Zero(Tag())), hn::Eq(q, hn::Zero(Tag())));
    };
    const auto has_no_term = [&](Doubles p, Doubles u1, Doubles w2, Doubles u2, Doubles w1) HWY_ATTR {
      return hn::Or(is_zero(p, p), hn::And(is_zero(u1, w2), is_zero(u2, w1)));
    };
    always_zero =
        hn::And(has_no_term(m.x, u.y, w.z, u.z, w.y),
                hn::And(has_no_term(m.y, u.z, w.x, u.x, w.z), has_no_term(m.z, u.x, w.y, u.y, w.x)));
  }

  /// Values and slopes without error bounds.
  HWY_INLINE Doubles estimate(Doubles t) const {
    const Doubles square = hn::Add(hn::Mul(powers[3], t), powers[2]);
    return hn::Add(hn::Mul(hn::Add(hn::Mul(square, t), powers[1]), t), powers[0]);
  }
  HWY_INLINE Doubles slope(Doubles t) const {
    const Doubles linear = hn::Add(hn::Mul(hn::Mul(set(3), powers[3]), t), hn::Mul(set(2), powers[2]));
    return hn::Add(hn::Mul(linear, t), powers[1]);
  }
  HWY_INLINE Doubles value(Doubles t) const {
    Coefficients before, after;
    bernstein.split(t, before, after);
    return after.c[0];
  }

  /// Whether there is no zero in [low, high], for the `wanted` lanes.
  HWY_NOINLINE Mask never_zero(Doubles low, Doubles high, Mask wanted) const {
    const Mask is_empty = hn::Ge(low, high);
    Coefficients part = bernstein, before, after;
    part.split(high, before, after);
    part = select(hn::Lt(high, set(1)), before, part);
    part.split(hn::Div(low, high), before, after);
    part = select(hn::Gt(low, hn::Zero(Tag())), after, part);
    return hn::Or(is_empty, part_has_one_sign<3>(part, error, hn::AndNot(is_empty, wanted)));
  }

  /// Whether the values at both ends are proven to have different signs.
  HWY_INLINE Mask changes_sign(Doubles low, Doubles high) const {
    const Doubles first = value(low), last = value(high), zero = hn::Zero(Tag());
    return hn::And(hn::Gt(hn::Min(hn::Abs(first), hn::Abs(last)), error),
                   hn::Xor(hn::Gt(first, zero), hn::Gt(last, zero)));
  }

  /// The zero in an interval over which the value is monotonic and changes its sign, for the `wanted` lanes.
  HWY_NOINLINE Doubles zero_between(Doubles low, Doubles high, Doubles at_low, Doubles at_high,
                                    Mask wanted) const {
    const Doubles zero = hn::Zero(Tag()), close = hn::Div(error, set(4));
    const Mask low_is_above = hn::Gt(at_low, zero);
    Doubles t = hn::Add(low, hn::Mul(hn::Sub(high, low), hn::Div(at_low, hn::Sub(at_low, at_high))));
    Mask open = wanted;
    for (int step = 0; step < 60 && !hn::AllFalse(Tag(), open); ++step) {
      const Mask is_within = hn::And(hn::Gt(t, low), hn::Lt(t, high));
      const Doubles middle = hn::Add(low, hn::Div(hn::Sub(high, low), set(2)));
      t = hn::IfThenElse(hn::AndNot(is_within, open), middle, t);
      const Doubles at = estimate(t);
      open = hn::AndNot(hn::Le(hn::Abs(at), close), open);
      const Mask on_low_side = hn::Not(hn::Xor(hn::Gt(at, zero), low_is_above));
      low = hn::IfThenElse(hn::And(open, on_low_side), t, low);
      high = hn::IfThenElse(hn::AndNot(on_low_side, open), t, high);
      t = hn::IfThenElse(open, hn::Sub(t, hn::Div(at, slope(t))), t);
    }
    return t;
  }
};

/// The times between which the volume is monotonic: 0, the turning points within the step, and 1. Where there
/// are fewer, the last are 1.
struct Knots {
  Doubles times[4], values[4];
  Mask turns[4];

  HWY_INLINE explicit Knots(const Volume& volume) {
    const Doubles zero = hn::Zero(Tag()), one = set(1);
    const Doubles a = hn::Mul(set(3), volume.powers[3]), b = volume.powers[2], d = volume.powers[1];
    const Doubles discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(a, d));
    const Mask has_two = hn::Gt(discriminant, zero);
    const Doubles q = hn::Neg(hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b)));
    const Doubles p = hn::Div(q, a), r = hn::Div(d, q);
    const Mask swap = hn::Lt(r, p);
    const Doubles first = hn::IfThenElse(swap, r, p), second = hn::IfThenElse(swap, p, r);
    const auto is_inside = [&](Doubles t) HWY_ATTR {
      return hn::And(has_two, hn::And(hn::Gt(t, zero), hn::Lt(t, one)));
    };
    const Mask first_inside = is_inside(first), second_inside = is_inside(second);
    times[0] = zero;
    times[1] = hn::IfThenElse(first_inside, first, hn::IfThenElse(second_inside, second, one));
    times[2] = hn::IfThenElse(hn::And(first_inside, second_inside), second, one);
    times[3] = one;
    for (int i = 0; i < 4; ++i) {
      values[i] = volume.estimate(times[i]);
      turns[i] = hn::And(hn::Gt(times[i], zero), hn::Lt(times[i], one));
    }
  }
};

/// Greatest magnitudes over the step of a vector that moves linearly, and of its change.
struct Extent {
  Doubles size, change;

  HWY_INLINE Extent(const Vector& start, const Vector& end)
      : size(hn::Max(largest_magnitude(start), largest_magnitude(end))),
        change(largest_magnitude(subtract<Tag>(end, start))) {}
};

/// Where a common point of the elements would lie at any time within [low, high].
///
/// With n = u × w, m = alpha u + beta w implies (m × w) · n = alpha n² and (u × m) · n = beta n², also where
/// n is 0. Each of these and n² is a sum of twelve products of four coordinates. At the middle of the
/// interval at most 20 roundings take part: three for each factor and eight for the rest. Towards the ends a
/// value changes by at most half the interval times twelve times the product with one factor replaced by its
/// change.
struct Place {
  Mask inside, outside;

  HWY_INLINE Place(const Places& start, const Places& end, Doubles low, Doubles high, bool is_square) {
    const Extent em(start.m, end.m), eu(start.u, end.u), ew(start.w, end.w);
    const Doubles half = hn::Div(hn::Sub(high, low), set(2));
    const Doubles drift = hn::Mul(set(12), hn::Add(half, set(0x1p-53)));
    const Doubles rounding = set(0x1p-44);  // above 12 · 20 · 2^-53
    const Doubles underflow = set(0x1p-700);
    const Doubles uw = hn::Mul(eu.size, ew.size);
    const auto change = [](const Extent& p, const Extent& q) HWY_ATTR {
      return hn::Add(hn::Mul(p.change, q.size), hn::Mul(p.size, q.change));
    };
    const Doubles uw_change = change(eu, ew), mw_change = change(em, ew), um_change = change(eu, em);
    const auto error = [&](const Extent& edge, Doubles m_change) HWY_ATTR {
      const Doubles rounded = hn::Mul(hn::Mul(hn::Mul(rounding, uw), em.size), edge.size);
      const Doubles drifted = hn::Add(hn::Mul(hn::Mul(uw_change, em.size), edge.size), hn::Mul(uw, m_change));
      return hn::Add(hn::Add(rounded, hn::Mul(drift, drifted)), underflow);
    };
    const Doubles alpha_error = error(ew, mw_change), beta_error = error(eu, um_change);
    const Doubles n_error = hn::Add(
        hn::Add(hn::Mul(hn::Mul(rounding, uw), uw), hn::Mul(hn::Mul(hn::Mul(drift, set(2)), uw), uw_change)),
        underflow);
    const Places middle(start, end, hn::Add(low, half));
    const Vector n = cross<Tag>(middle.u, middle.w);
    const Doubles alpha = dot<Tag>(cross<Tag>(middle.m, middle.w), n),
                  beta = dot<Tag>(cross<Tag>(middle.u, middle.m), n), one = dot<Tag>(n, n);
    inside = hn::Gt(one, n_error);
    outside = hn::Lt(one, one);
    const auto border = [&](Doubles value, Doubles bound) HWY_ATTR {
      outside = hn::Or(outside, hn::Lt(value, hn::Neg(bound)));
      inside = hn::And(inside, hn::Gt(value, bound));
    };
    border(alpha, alpha_error);
    border(beta, beta_error);
    if (is_square) {
      border(hn::Sub(one, alpha), hn::Add(alpha_error, n_error));
      border(hn::Sub(one, beta), hn::Add(beta_error, n_error));
    } else {
      border(hn::Sub(hn::Sub(one, alpha), beta),
             hn::Mul(set(2), hn::Add(hn::Add(alpha_error, beta_error), n_error)));
    }
  }
};

/// Goes through the short closed intervals of time near zeros of the volume, ascending, until one of them
/// decides.
class Search {
 public:
  HWY_INLINE Search(const MotionBlock& block, std::size_t first, std::size_t count, bool is_square)
      : wanted_(hn::FirstN(Tag(), count)),
        start_(block, 0, first, wanted_),
        end_(block, 9, first, wanted_),
        volume_(start_, end_),
        is_square_(is_square) {
    const Doubles zero = hn::Zero(Tag());
    wanted_ = hn::And(volume_.in_range, wanted_);
    apart_ = hn::And(wanted_, part_has_one_sign<3>(volume_.bernstein, volume_.error, wanted_));
    open_ = hn::AndNot(apart_, wanted_);
    touching_ = has_interval_ = hn::Lt(zero, zero);
    passed_ = time_ = low_ = high_ = zero;
  }

  HWY_INLINE void run() {
    const Doubles zero = hn::Zero(Tag()), twice_error = hn::Mul(set(2), volume_.error);
    const Knots knots(volume_);
    for (int k = 0; k < 4 && !hn::AllFalse(Tag(), open_); ++k) {
      const Doubles t = knots.times[k], here = knots.values[k];
      const Mask is_near = hn::And(open_, hn::Le(hn::Abs(here), twice_error));
      if (!hn::AllFalse(Tag(), is_near)) {
        const Doubles curvature = hn::Add(hn::Mul(hn::Mul(set(3), volume_.powers[3]), t), volume_.powers[2]);
        const Doubles of_turn = hn::Mul(set(4), hn::Sqrt(hn::Div(volume_.error, hn::Abs(curvature))));
        const Doubles of_slope = hn::Div(hn::Mul(set(4), volume_.error), hn::Abs(volume_.slope(t)));
        add(is_near, t, hn::IfThenElse(knots.turns[k], of_turn, of_slope));
      }
      if (k == 3) break;
      const Doubles next = knots.values[k + 1];
      const Mask changes = hn::And(open_, hn::Xor(hn::Gt(here, zero), hn::Gt(next, zero)));
      if (hn::AllFalse(Tag(), changes)) continue;
      const Doubles root = volume_.zero_between(t, knots.times[k + 1], here, next, changes);
      add(changes, root, hn::Div(twice_error, hn::Abs(volume_.slope(root))));
    }
    decide(hn::And(open_, has_interval_));
    if (!hn::AllFalse(Tag(), open_))
      apart_ = hn::Or(apart_, hn::And(open_, volume_.never_zero(passed_, set(1), open_)));
  }

  HWY_INLINE void store(std::size_t first, CoplanarSearch& search) const {
    const Tag d;
    hn::StoreU(time_, d, search.times + first);
    search.apart |= mask_bits(d, apart_) << first;
    search.touching |= mask_bits(d, touching_) << first;
    const auto& c = volume_.bernstein.c;
    const Mask has_sign_after_start = Coefficients{{c[1], c[1], c[2], c[3]}}.one_sign(volume_.error);
    const Mask is_clear = hn::And(wanted_, hn::Or(volume_.always_zero, has_sign_after_start));
    search.clear_after_start |= mask_bits(d, is_clear) << first;
  }

 private:
  /// Adds an interval around t. It joins the last one where they overlap.
  HWY_INLINE void add(Mask lanes, Doubles t, Doubles reach) {
    // Only short intervals are useful. NaN gives the whole step.
    const Doubles zero = hn::Zero(Tag()), one = set(1);
    const Doubles half = hn::IfThenElse(hn::Lt(reach, one), hn::Add(reach, set(0x1p-52)), one);
    const Doubles low = hn::Max(hn::Sub(t, half), zero), high = hn::Min(hn::Add(t, half), one);
    const Mask joins = hn::And(hn::And(lanes, has_interval_), hn::Ge(high_, low));
    decide(hn::AndNot(joins, hn::And(lanes, has_interval_)));
    low_ = hn::IfThenElse(joins, hn::Min(low_, low), hn::IfThenElse(lanes, low, low_));
    high_ = hn::IfThenElse(joins, hn::Max(high_, high), hn::IfThenElse(lanes, high, high_));
    has_interval_ = hn::Or(has_interval_, lanes);
  }

  /// Decides by the last interval, or goes on after it where a common point would be outside.
  HWY_NOINLINE void decide(Mask lanes) {
    if (hn::AllFalse(Tag(), lanes)) return;
    const Place place(start_, end_, low_, high_, is_square_);
    const Mask is_clear = hn::And(lanes, volume_.never_zero(passed_, low_, lanes));
    const Doubles longest = hn::Min(set(toi_tolerance / 2), hn::Mul(set(toi_relative_tolerance / 2), low_));
    const Mask is_short = hn::Le(hn::Sub(high_, low_), longest);
    const Mask touches = hn::And(hn::And(is_clear, hn::AndNot(place.outside, place.inside)),
                                 hn::And(is_short, volume_.changes_sign(low_, high_)));
    touching_ = hn::Or(touching_, touches);
    time_ = hn::IfThenElse(touches, low_, time_);
    const Mask goes_on = hn::And(is_clear, place.outside);
    passed_ = hn::IfThenElse(goes_on, high_, passed_);
    open_ = hn::And(open_, hn::Or(hn::Not(lanes), goes_on));
  }

  Mask wanted_;
  Places start_, end_;
  Volume volume_;
  bool is_square_;
  Mask open_, apart_, touching_, has_interval_;
  Doubles passed_, time_, low_, high_;  // `low_` and `high_` are those of the last interval
};

void search_block(const MotionBlock& block, std::size_t count, bool is_square, CoplanarSearch& search) {
  search.apart = search.touching = search.clear_after_start = 0;
  for (std::size_t first = 0; first < count; first += hn::Lanes(Tag())) {
    Search part(block, first, count - first, is_square);
    part.run();
    part.store(first, search);
  }
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(search_block);

void MotionBlock::set(std::size_t pair, const RelativeMotion& motion) {
  std::size_t row = 0;
  for (const auto* places : {&motion.start, &motion.end}) {
    for (const Vec3d& v : {places->m, places->u, places->w}) {
      for (int axis = 0; axis < 3; ++axis) rows_[row++][pair] = v[axis];
    }
  }
}

void search_coplanar_times(const MotionBlock& block, std::size_t count, bool is_square,
                           CoplanarSearch& search) {
  HWY_DYNAMIC_DISPATCH(search_block)(block, count, is_square, search);
}

}  // namespace supple
#endif
