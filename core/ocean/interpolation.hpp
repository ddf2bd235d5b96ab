#pragma once

#include <span>

namespace glidehelm::ocean {

/// How values between nodes are made. `nearest` in space, depth and time; `linear` in all; `cubic` and `akima` are linear
/// on the horizontal grid and smooth in depth and in time, as Eichhorn (section 3.4) takes Akima: a column or a series has
/// jumps (a pycnocline, the turn of a tide) beside which a smooth curve must not swing.
enum class Interpolation { nearest, linear, cubic, akima };

/// The value at `fraction` between x[k] and x[k+1] by a cubic Hermite polynomial. Its slopes are, for `cubic`, those of
/// the parabola through three neighbouring points (exact on parabolas), for `akima`, Akima's (1970, eq. 1) weighted mean
/// of neighbouring secants (no overshoot beside a step). A missing neighbour at the end of the axis counts as a straight
/// continuation. `linear` gives the secant. Precondition: k + 1 < x.size() == v.size(), x ascending.
double interpolate(Interpolation how, std::span<const double> x, std::span<const double> v, std::size_t k,
                   double fraction);

/// The largest ratio of neighbouring steps of an axis (≥ 1): how far smooth interpolation may overshoot.
double step_ratio(std::span<const double> axis);

/// A proven bound of |interpolated| / max |node| along one axis, for vectors interpolated component by component: 1 for
/// nearest and linear, else 1 + √2·(8/27)·2·ratio, because each slope is a mean of neighbouring secants, each at most
/// 2·max/step, and the two slope polynomials of Hermite's form are at most 4/27 each. Over two axes, one after the other,
/// the bounds multiply.
double overshoot_bound(Interpolation how, double step_ratio);

}  // namespace glidehelm::ocean
