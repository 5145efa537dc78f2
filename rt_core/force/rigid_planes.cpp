// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/rigid_planes.hpp"

#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus
{

namespace
{

/// Difference below which planes count as one, as a share of the tool's size; the plane that
/// restrains most is kept.
constexpr double kSamePlane = 1e-3;
/// Limits of a seam, the edge of a touched face: is_seam() leaves its plane out. A seam's plane
/// leans to the face by kLeastLean .. kMostLean, and has a gap of at most kSeamGap radii. Its edge
/// is at most kOnFace x lean x radius off the face's plane: a face that really rises is touched
/// above that plane. The tool's point is at most kAbove x lean^2 x radius lower than over the face:
/// an edge that carries the tool has a lower point.
constexpr double kLeastLean = 1e-3;
constexpr double kMostLean = 0.8;
constexpr double kSeamGap = 0.5;
constexpr double kOnFace = 1e-3;
constexpr double kAbove = 0.1;
/// Distance, as a share of the radius, within which a seam's tool point must lie among the points
/// that touch the face's plane: these support the tool without the edge.
constexpr double kSameSupport = 0.01;
/// Gap of a plane up to which friction may hold, as a share of the radius.
constexpr double kTouchingGap = 0.02;
/// Slip below which a contact counts as not slipping, as a share of the radius.
constexpr double kLeastSlip = 1e-4;
/// Relative difference between assumed and allowed friction up to which it is not corrected.
constexpr double kSameFriction = 1e-4;

constexpr double kHalfRoot = 0.7071067811865476; ///< sin 45 degrees.
constexpr double kSin22 = 0.3826834323650898;    ///< sin 22.5 degrees.
constexpr double kCos22 = 0.9238795325112867;    ///< cos 22.5 degrees.
/// Eight directions in a plane, over half a turn.
constexpr std::array<std::array<double, 2>, 8> kDirections{{{1.0, 0.0},
                                                            {kCos22, kSin22},
                                                            {kHalfRoot, kHalfRoot},
                                                            {kSin22, kCos22},
                                                            {0.0, 1.0},
                                                            {-kSin22, kCos22},
                                                            {-kHalfRoot, kHalfRoot},
                                                            {-kCos22, kSin22}}};

Motion<6> to_motion(const Vec3& translation, const Vec3& rotation) noexcept
{
    Motion<6> motion;
    motion.head<3>() = translation;
    motion.tail<3>() = rotation;
    return motion;
}

double pressure_of(const NearestMotion<6>& held) noexcept
{
    double pressure = 0.0;
    for (std::size_t i = 0; i < held.held_by.size(); ++i)
    {
        pressure += held.reactions[i];
    }
    return pressure;
}

/// Returns a unit vector perpendicular to a unit vector.
Vec3 across(const Vec3& normal) noexcept
{
    const Vec3 axis = std::abs(normal.x()) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    return normal.cross(axis).normalized();
}

} // namespace

void RigidPlanes::begin(const Vec3& place_m, double arm_m, double size_m, double radius_m,
                        const Motion<6>& gone) noexcept
{
    spaces_.clear();
    touches_.clear();
    grips_.clear();
    place_m_ = place_m;
    arm_m_ = arm_m;
    const double ratio = arm_m / size_m;
    turn_weight_ = ratio * ratio;
    radius_m_ = radius_m;
    gone_ = gone;
    exceeds_capacity_ = false;
}

Vec3 RigidPlanes::lever_m(std::uint32_t i) const noexcept
{
    return touches_[i].on_tool_m - radius_m_ * touches_[i].normal - place_m_;
}

void RigidPlanes::add(const RigidTouch& touch, const RigidGrip& grip) noexcept
{
    if (touch.normal == Vec3(0.0, 0.0, 0.0))
    {
        return; // A face without area has no normal; its neighbours hold.
    }
    const Vec3 lever = (touch.on_tool_m - place_m_) / arm_m_;
    const HalfSpace<6> space{to_motion(touch.normal, lever.cross(touch.normal)),
                             radius_m_ - touch.normal.dot(touch.on_tool_m - touch.on_surface_m)};
    std::size_t least = 0;
    for (std::size_t i = 0; i < spaces_.size(); ++i)
    {
        const HalfSpace<6>& other = spaces_[i];
        if (apart_sq(other, space) < kSamePlane * kSamePlane)
        {
            replace(i, space, touch, grip);
            return;
        }
        least = other.offset < spaces_[least].offset ? i : least;
    }
    if (!spaces_.full())
    {
        spaces_.push_back(space);
        touches_.push_back(touch);
        grips_.push_back(grip);
        return;
    }
    exceeds_capacity_ = true;
    replace(least, space, touch, grip);
}

void RigidPlanes::replace(std::size_t plane, const HalfSpace<6>& space, const RigidTouch& touch,
                          const RigidGrip& grip) noexcept
{
    if (space.offset > spaces_[plane].offset)
    {
        spaces_[plane] = space;
        touches_[plane] = touch;
        grips_[plane] = grip;
    }
}

RigidPlanes::Ground::Ground(std::uint32_t nearest, const Vec3& normal) noexcept
    : face(nearest), first(across(normal)), second(normal.cross(first))
{
    high_m.fill(-kInfinity);
    low_m.fill(kInfinity);
}

RigidPlanes::Ground::Heights RigidPlanes::Ground::heights(const Vec3& point_m) const noexcept
{
    const double x = first.dot(point_m);
    const double y = second.dot(point_m);
    Heights heights_m; // NOLINT(cppcoreguidelines-pro-type-member-init): the loop fills it.
    for (std::size_t i = 0; i < heights_m.size(); ++i)
    {
        heights_m[i] = kDirections[i][0] * x + kDirections[i][1] * y;
    }
    return heights_m;
}

void RigidPlanes::Ground::support(const Vec3& point_m) noexcept
{
    const Heights here_m = heights(point_m);
    for (std::size_t i = 0; i < here_m.size(); ++i)
    {
        high_m[i] = std::max(high_m[i], here_m[i]);
        low_m[i] = std::min(low_m[i], here_m[i]);
    }
}

bool RigidPlanes::Ground::is_among_supports(const Vec3& point_m, double off_m) const noexcept
{
    const Heights here_m = heights(point_m);
    bool is_among = true;
    for (std::size_t i = 0; i < here_m.size(); ++i)
    {
        is_among &= here_m[i] <= high_m[i] + off_m && here_m[i] >= low_m[i] - off_m;
    }
    return is_among;
}

RigidPlanes::Grounds RigidPlanes::grounds() const noexcept
{
    Grounds grounds;
    for (std::uint32_t i = 0; i < spaces_.size(); ++i)
    {
        const RigidTouch& touch = touches_[i];
        if (!touch.is_face)
        {
            continue;
        }
        auto* same = std::ranges::find_if(
            grounds,
            [&](const Ground& ground)
            {
                const RigidTouch& face = touches_[ground.face];
                const Vec3 between_m = touch.on_surface_m - face.on_surface_m;
                return face.surface == touch.surface &&
                       (touch.normal - face.normal).squaredNorm() < kLeastLean * kLeastLean &&
                       std::abs(face.normal.dot(between_m)) < kOnFace * kLeastLean * radius_m_;
            });
        if (same == grounds.end())
        {
            if (grounds.full())
            {
                continue;
            }
            grounds.push_back(Ground(i, touch.normal));
            same = grounds.end() - 1;
        }
        same->face = spaces_[i].offset > spaces_[same->face].offset ? i : same->face;
        same->support(touch.on_tool_m - place_m_);
    }
    return grounds;
}

bool RigidPlanes::is_seam(std::size_t plane, const Ground& ground) const noexcept
{
    const RigidTouch& touch = touches_[plane];
    const RigidTouch& face = touches_[ground.face];
    const double lean = (touch.normal - face.normal).norm();
    const double edge_m = face.normal.dot(touch.on_surface_m - face.on_surface_m);
    const double tool_m = face.normal.dot(touch.on_tool_m - face.on_surface_m);
    return face.surface == touch.surface && spaces_[ground.face].offset >= spaces_[plane].offset &&
           lean > kLeastLean && lean < kMostLean &&
           std::abs(edge_m) <= kOnFace * lean * radius_m_ &&
           tool_m >= radius_m_ * (1.0 - kAbove * lean * lean) &&
           ground.is_among_supports(touch.on_tool_m - place_m_, kSameSupport * radius_m_);
}

void RigidPlanes::leave_out_seams() noexcept
{
    const Grounds grounds = this->grounds();
    StaticVector<std::size_t, kMaxHalfSpaces> kept;
    for (std::size_t i = 0; i < spaces_.size(); ++i)
    {
        const bool may_be_seam = !touches_[i].is_face && spaces_[i].offset >= -kSeamGap * radius_m_;
        if (!may_be_seam ||
            std::ranges::none_of(grounds, [&](const Ground& ground) { return is_seam(i, ground); }))
        {
            kept.push_back(i);
        }
    }
    for (std::size_t i = 0; i < kept.size(); ++i)
    {
        spaces_[i] = spaces_[kept[i]];
        touches_[i] = touches_[kept[i]];
        grips_[i] = grips_[kept[i]];
    }
    while (spaces_.size() > kept.size())
    {
        (void)spaces_.pop_back();
        (void)touches_.pop_back();
        (void)grips_.pop_back();
    }
}

RigidMotion RigidPlanes::nearest(const Motion<6>& wanted) noexcept
{
    leave_out_seams();
    RigidMotion answer;
    const NearestMotion<6> held = plain(wanted, answer.is_over_constrained);
    answer.motion = held.motion;
    bool rubs = false;
    for (std::size_t i = 0; i < held.held_by.size(); ++i)
    {
        const std::uint32_t plane = held.held_by[i];
        answer.pushes.push_back({plane, spaces_[plane].normal, held.reactions[i]});
        rubs = rubs || grips_[plane].friction > 0.0;
    }
    if (answer.is_over_constrained)
    {
        return answer;
    }
    const Chosen chosen = rubs ? choose(held) : Chosen{};
    if (chosen.empty()) // There is no friction, or no contact touches yet.
    {
        rub(held, wanted, Motion<6>::Zero(), answer);
        return answer;
    }
    tilt(chosen, wanted);
    const NearestMotion<6> tilted = nearest_motion<6>(tilted_.view(), wanted);
    if (!tilted.is_feasible || tilted.held_by.empty())
    {
        return answer; // The surfaces part under the tool, so no sticking place is known.
    }
    return is_stuck(tilted) ? stuck(tilted) : sliding(tilted, wanted);
}

/// Nearest motion that the plain planes allow. If a gap is too narrow for the tool, the planes hold
/// the tool in place.
NearestMotion<6> RigidPlanes::plain(const Motion<6>& wanted, bool& is_over_constrained) noexcept
{
    NearestMotion<6> nearest = nearest_motion<6>(spaces_.view(), wanted);
    if (nearest.is_feasible)
    {
        return nearest;
    }
    is_over_constrained = true;
    for (HalfSpace<6>& space : spaces_)
    {
        space.offset = std::min(space.offset, 0.0);
    }
    return nearest_motion<6>(spaces_.view(), wanted);
}

/// Squared difference of two planes' normals, with the tool's size as arm.
double RigidPlanes::apart_sq(const HalfSpace<6>& a, const HalfSpace<6>& b) const noexcept
{
    const Motion<6> between = a.normal - b.normal;
    return between.head<3>().squaredNorm() + turn_weight_ * between.tail<3>().squaredNorm();
}

/// Chooses the contacts that friction may hold: first holding planes, then each time the touching
/// plane that differs most from those chosen. A flat tool needs all its corners to stick, as its
/// load shifts.
RigidPlanes::Chosen RigidPlanes::choose(const NearestMotion<6>& plain) const noexcept
{
    Chosen chosen;
    struct Candidate
    {
        std::uint32_t plane{0};
        /// Squared difference from the chosen planes; 0: no longer a candidate.
        double apart_sq{kInfinity};
    };
    StaticVector<Candidate, kMaxHalfSpaces> candidates;
    for (std::uint32_t i = 0; i < spaces_.size(); ++i)
    {
        if (spaces_[i].offset >= -kTouchingGap * radius_m_ && grips_[i].friction > 0.0)
        {
            candidates.push_back({i});
        }
    }
    const auto take = [&](Candidate& taken)
    {
        taken.apart_sq = 0.0;
        chosen.push_back(taken.plane);
        for (Candidate& other : candidates)
        {
            if (other.apart_sq > 0.0)
            {
                other.apart_sq =
                    std::min(other.apart_sq, apart_sq(spaces_[other.plane], spaces_[taken.plane]));
            }
        }
    };
    for (const std::uint32_t plane : plain.held_by)
    {
        auto* const candidate = std::ranges::find(candidates, plane, &Candidate::plane);
        if (candidate != candidates.end() && candidate->apart_sq > 0.0)
        {
            take(*candidate);
        }
    }
    while (!chosen.full() && !candidates.empty())
    {
        auto* const farthest = std::ranges::max_element(candidates, {}, &Candidate::apart_sq);
        if (!(farthest->apart_sq > kSamePlane * kSamePlane))
        {
            break;
        }
        take(*farthest);
    }
    return chosen;
}

/// Builds the friction pyramids of the chosen contacts, followed by the plain planes of the others,
/// as many as fit.
void RigidPlanes::tilt(const Chosen& chosen, const Motion<6>& wanted) noexcept
{
    tilted_.clear();
    tilts_.clear();
    untilted_.clear();
    for (const std::uint32_t touch : chosen)
    {
        tilt(touch, wanted);
    }
    for (std::uint32_t i = 0; i < spaces_.size() && !tilted_.full(); ++i)
    {
        if (std::ranges::find(chosen, i) == chosen.end())
        {
            tilted_.push_back({spaces_[i].normal, std::min(spaces_[i].offset, 0.0)});
            untilted_.push_back(i);
        }
    }
}

/// Tilts one contact's plane into the four planes of its pyramid. A plane that the tool is too near
/// to gets an offset of 0, so that sticking is always possible. The surface's own motion moves the
/// pyramid along.
void RigidPlanes::tilt(std::uint32_t touch, const Motion<6>& wanted) noexcept
{
    const RigidGrip& grip = grips_[touch];
    const Vec3& normal = touches_[touch].normal;
    const Vec3 lever = lever_m(touch) / arm_m_;
    const Vec3 way = wanted.head<3>() + wanted.tail<3>().cross(lever) - grip.way_m;
    const Vec3 along = way - normal.dot(way) * normal;
    const double length = along.norm();
    const Vec3 first = length > kLeastSlip * radius_m_ ? Vec3(along / length) : across(normal);
    const Vec3 second = normal.cross(first);
    for (const Vec3& tangent : {first, Vec3(-first), second, Vec3(-second)})
    {
        const Vec3 drag_m = grip.friction * tangent;
        const Motion<6> drag = to_motion(drag_m, lever.cross(drag_m));
        tilted_.push_back({spaces_[touch].normal + drag,
                           std::min(spaces_[touch].offset, 0.0) + drag_m.dot(grip.way_m)});
        tilts_.push_back({touch, drag});
    }
}

/// True if no pushing tilted plane lifts the tool; a slipping tool is lifted by the slip times the
/// coefficient.
bool RigidPlanes::is_stuck(const NearestMotion<6>& tilted) const noexcept
{
    return std::ranges::all_of(tilted.held_by,
                               [&](std::uint32_t plane)
                               {
                                   if (plane >= tilts_.size())
                                   {
                                       return true;
                                   }
                                   const std::uint32_t touch = tilts_[plane].touch;
                                   const double lift_m = spaces_[touch].normal.dot(tilted.motion) -
                                                         std::min(spaces_[touch].offset, 0.0);
                                   return lift_m <= grips_[touch].friction * kLeastSlip * radius_m_;
                               });
}

RigidMotion RigidPlanes::stuck(const NearestMotion<6>& tilted) noexcept
{
    RigidMotion answer;
    answer.sticks = true;
    for (std::size_t i = 0; i < tilted.held_by.size(); ++i)
    {
        const std::uint32_t plane = tilted.held_by[i];
        const std::uint32_t touch =
            plane < tilts_.size() ? tilts_[plane].touch : untilted_[plane - tilts_.size()];
        answer.pushes.push_back({touch, tilted_[plane].normal, tilted.reactions[i]});
    }
    // The plain planes also restrain contacts that did not fit above, and those that the tool is
    // too near to.
    const NearestMotion<6> free = plain(tilted.motion, answer.is_over_constrained);
    answer.motion = free.motion;
    return answer;
}

/// Share of the friction `most` that the pressure of the planes allows, 0 .. 1.
double RigidPlanes::share_of(const NearestMotion<6>& plain, double most) const noexcept
{
    double sum = 0.0;
    for (std::size_t i = 0; i < plain.held_by.size(); ++i)
    {
        sum += grips_[plain.held_by[i]].dynamic * plain.reactions[i];
    }
    return sum < most ? sum / most : 1.0;
}

RigidMotion RigidPlanes::sliding(const NearestMotion<6>& tilted, const Motion<6>& wanted) noexcept
{
    Motion<6> drag = Motion<6>::Zero();
    double most = 0.0;
    for (std::size_t i = 0; i < tilted.held_by.size(); ++i)
    {
        const std::uint32_t plane = tilted.held_by[i];
        if (plane < tilts_.size())
        {
            const RigidGrip& grip = grips_[tilts_[plane].touch];
            drag += tilted.reactions[i] * grip.dynamic / grip.friction * tilts_[plane].drag;
            most += tilted.reactions[i] * grip.dynamic;
        }
    }
    RigidMotion answer;
    answer.slides = true;
    NearestMotion<6> held = plain(wanted + drag, answer.is_over_constrained);
    if (share_of(held, most) < 1.0 - kSameFriction)
    {
        held = plain(wanted + share_of(held, most) * drag, answer.is_over_constrained);
    }
    rub(held, wanted, share_of(held, most) * drag, answer);
    return answer;
}

/// Sets motion and pushes of a tool that planes hold, with the friction `drag` and with viscosity.
void RigidPlanes::rub(const NearestMotion<6>& held, const Motion<6>& wanted, const Motion<6>& drag,
                      RigidMotion& answer) noexcept
{
    NearestMotion<6> rubbed = held;
    Motion<6> all = drag;
    if (const std::optional<Viscosity> viscosity = viscosity_of(held))
    {
        const SymmetricFactor& factor = viscosity->factor;
        tilted_.clear();
        for (const HalfSpace<6>& space : spaces_)
        {
            tilted_.push_back({factor.forward(space.normal), space.offset});
        }
        const Motion<6> target = factor.forward(wanted + drag - viscosity->gone);
        const NearestMotion<6> found = nearest_motion<6>(tilted_.view(), target);
        if (found.is_feasible)
        {
            rubbed = found;
            rubbed.motion = factor.backward(found.motion);
            all = drag - (factor.times(rubbed.motion) - rubbed.motion + viscosity->gone);
        }
    }
    answer.motion = rubbed.motion;
    const double pressure = pressure_of(rubbed);
    // Each pressing plane carries a share of the drag, so a push is its normal plus that share.
    const Motion<6> part = pressure > 0.0 ? Motion<6>(all / pressure) : Motion<6>::Zero();
    answer.pushes.clear();
    for (std::size_t i = 0; i < rubbed.held_by.size(); ++i)
    {
        const std::uint32_t plane = rubbed.held_by[i];
        answer.pushes.push_back({plane, spaces_[plane].normal + part, rubbed.reactions[i]});
    }
}

/// True if holding plane `i` touches, presses and is viscous.
bool RigidPlanes::drags(const NearestMotion<6>& held, std::size_t i) const noexcept
{
    const std::uint32_t plane = held.held_by[i];
    return grips_[plane].viscous * held.reactions[i] > 0.0 &&
           spaces_[plane].offset >= -kTouchingGap * radius_m_;
}

/// Viscosity of the contacts, each by its share of the pressure; none if no contact is viscous.
std::optional<RigidPlanes::Viscosity>
RigidPlanes::viscosity_of(const NearestMotion<6>& held) const noexcept
{
    std::size_t first = 0;
    while (first < held.held_by.size() && !drags(held, first))
    {
        ++first;
    }
    if (first == held.held_by.size())
    {
        return std::nullopt;
    }
    Viscosity viscosity;
    const double pressure = pressure_of(held);
    SymmetricFactor::Matrix metric = SymmetricFactor::Matrix::Identity();
    for (std::size_t i = first; i < held.held_by.size(); ++i)
    {
        if (!drags(held, i))
        {
            continue;
        }
        const std::uint32_t plane = held.held_by[i];
        const double part = grips_[plane].viscous * held.reactions[i] / pressure;
        const Vec3 lever = lever_m(plane) / arm_m_;
        const Vec3& normal = touches_[plane].normal;
        const auto drag_of = [&](const Vec3& way)
        {
            const Vec3 along = part * (way - normal.dot(way) * normal);
            return to_motion(along, lever.cross(along));
        };
        for (int column = 0; column < 6; ++column)
        {
            const Motion<6> unit = Motion<6>::Unit(column);
            metric.col(column) += drag_of(unit.head<3>() + unit.tail<3>().cross(lever));
        }
        viscosity.gone +=
            drag_of(gone_.head<3>() + gone_.tail<3>().cross(lever) - grips_[plane].frame_way_m);
    }
    viscosity.factor = SymmetricFactor(metric);
    return viscosity;
}

} // namespace tactus
