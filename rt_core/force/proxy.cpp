// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/proxy.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/force/texture.hpp"
#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

/// Share of the goal's depth that counts as possible displacement along a curved surface in a
/// frame.
constexpr double kDipShare = 0.1;
/// Displacement with the last list, as a share of the radius, above which a further list is
/// requested.
constexpr double kWorthAList = 0.05;
/// Gap between sphere and surface within which a moving proxy has contact, as a share of the
/// radius.
constexpr double kNearlyTouching = 0.1;
/// Force below which a push has no direction (for example with a stiffness of 0) and the last
/// contact's normal is kept.
constexpr double kLeastPush_n = 1e-150;

/// Planes of one step, and the face of each.
struct StepPlanes
{
    StaticVector<HalfSpace<3>, kMaxHalfSpaces> planes;
    StaticVector<std::uint32_t, kMaxHalfSpaces> faces;

    [[nodiscard]] bool has(std::uint32_t face) const noexcept
    {
        return std::ranges::find(faces.view(), face) != faces.view().end();
    }
    void add(std::uint32_t face, const HalfSpace<3>& plane) noexcept
    {
        faces.push_back(face);
        planes.push_back(plane);
    }
    /// Keeps only the planes that hold the motion `found`.
    void compact(const NearestMotion<3>& found) noexcept
    {
        const StepPlanes before = *this;
        faces.clear();
        planes.clear();
        for (const std::uint32_t i : found.held_by)
        {
            add(before.faces[i], before.planes[i]);
        }
    }
    /// Shortest motion out of the planes, if the tool is behind one of them by more than `least`,
    /// after objects moved into it; otherwise zero.
    [[nodiscard]] Vec3 way_out(double least) const noexcept
    {
        const bool is_inside = std::ranges::any_of(planes.view(), [least](const HalfSpace<3>& plane)
                                                   { return plane.offset > least; });
        return is_inside ? nearest_motion<3>(planes.view(), Vec3(0.0, 0.0, 0.0)).motion
                         : Vec3(0.0, 0.0, 0.0);
    }
};

/// Calls nearest_motion() and counts its work: a search passes through its planes about eight
/// times.
NearestMotion<3> search(Vicinity& near, const StepPlanes& step, const Vec3& wanted) noexcept
{
    near.use(1 + static_cast<std::uint32_t>(step.planes.size()) / 8);
    return nearest_motion<3>(step.planes.view(), wanted);
}

/// Returns the motion, shortened to a length of `room`.
Vec3 within(const Vec3& motion, double room) noexcept
{
    const double length = motion.norm();
    return length > room ? Vec3(motion * (room / length)) : motion;
}

/// Returns the motion nearest to `wanted` that enters no triangle, shortened to `room`. `found` is
/// the motion that the planes of `step` allow; `step` receives the faces that it would enter. If
/// the search is cut, returns the part of the motion that is proven to be free.
NearestMotion<3> nearest_free_motion(Vicinity& near, const Vec3& wanted, double radius, double room,
                                     StepPlanes& step, NearestMotion<3> found) noexcept
{
    found.motion = within(found.motion, room);
    for (std::uint32_t round = 0; round < kStepRounds && found.is_feasible && !near.is_spent();
         ++round)
    {
        const std::optional<std::uint32_t> entered = near.find_entered(found.motion, radius);
        if (!entered && near.is_spent())
        {
            break;
        }
        if (!entered || step.has(*entered))
        {
            return found;
        }
        if (step.planes.full())
        {
            step.compact(found);
        }
        step.add(*entered, near.half_space(*entered, radius));
        found = search(near, step, wanted);
        found.motion = within(found.motion, room);
    }
    if (found.is_feasible)
    {
        found.motion *= near.free_share(found.motion, radius);
    }
    return found;
}

/// Component of a vector along all holding planes; their normals are independent.
Vec3 along_all(const Vec3& vector, const StepPlanes& planes,
               std::span<const std::uint32_t> held_by) noexcept
{
    if (held_by.size() > 2)
    {
        return {0.0, 0.0, 0.0};
    }
    if (held_by.size() == 2)
    {
        const Vec3 edge = planes.planes[held_by[0]].normal.cross(planes.planes[held_by[1]].normal);
        return edge * (edge.dot(vector) / edge.squaredNorm());
    }
    const Vec3& normal = planes.planes[held_by[0]].normal;
    return vector - normal * normal.dot(vector);
}

/// True if the material resists motion along its surface.
bool rubs(const Material& material) noexcept
{
    return material.static_friction > 0.0 || material.viscosity_n_s_per_m > 0.0 ||
           material.texture_height_m > 0.0;
}

/// Distance from the tool's centre within which the surface is known, in metres of the world.
double known(const PlacedSurface& placed) noexcept
{
    const DistanceAnswer& answer = placed.surface->answer;
    return std::max(answer.certified_radius_m, answer.lower_m) * placed.pose->scale;
}

} // namespace

/// Contacts of the proxy at one place, before it is checked which further faces a motion would
/// enter.
struct Proxy::Touch
{
    Hold hold;
    StepPlanes planes; ///< Planes of the contacts.
    Vec3 wanted; ///< Wanted displacement: to the goal, or to the goal as raised by force shading.
    NearestMotion<3> held;    ///< Part of `wanted` that the planes allow.
    Vec3 kept{0.0, 0.0, 0.0}; ///< Part of the slip that friction and textures hold back.
};

Proxy::Proxy(ToolSpec spec) noexcept : spec_(std::move(spec)), radius_(spec_.radius_m) {}

ToolOutput Proxy::respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                          double clear_m, std::uint32_t planes) noexcept
{
    anchor_ = position_;
    clear_m_ = clear_m;
    elapsed_s_ = goal.elapsed_s;
    radius_ = find_radius(surfaces);
    const double travel = free_travel(surfaces, clear_m);
    const bool halted = !(travel > 0.0);
    goes_on_ = false;
    if (!is_on_)
    {
        begin_frame();
    }
    else if (halted)
    {
        is_on_ = false;
        ToolOutput nothing;
        nothing.halted = true;
        return nothing;
    }
    is_on_ = false;
    catch_up_ = catch_up_before_;
    ++lists_;
    planes_left_ = planes;
    Motion motion = Motion::data_limited;
    if (halted)
    {
        keep_clearances(surfaces, nullptr);
    }
    else
    {
        motion = follow(goal.position_m, travel, surfaces);
        goes_on_ = is_worth_going_on(motion, surfaces);
    }
    ToolOutput output;
    output.proxy_m = position_;
    output.proxy_rotation = goal.rotation;
    output.in_contact = in_contact_;
    output.halted = halted;
    output.over_constrained = motion == Motion::over_constrained || was_overrun_;
    output.capacity_exceeded = exceeds_capacity_;
    output.data_limited =
        motion == Motion::data_limited && !halted && is_short_of(surfaces, travel);
    output.under_way = !halted && motion != Motion::at_rest && motion != Motion::over_constrained;
    output.cut_short = motion == Motion::out_of_planes;
    output.lag_m = halted || output.under_way ? way_to_m(goal) : 0.0;
    output.stiffness_n_per_m =
        in_contact_ ? hold_.stiffness / hold_.depth_m * (hold_.stiffening / hold_.depth_m) : 0.0;
    const bool is_held = halted || output.over_constrained;
    if (in_contact_ && !is_held)
    {
        output.force_n = caught_up(goal);
    }
    else
    {
        output.force_n = in_contact_ ? held_force(goal.position_m) : Vec3(0.0, 0.0, 0.0);
        catch_up_.follow(output.force_n);
    }
    waits_ = is_held || output.data_limited || output.cut_short;
    return output;
}

void Proxy::begin_frame() noexcept
{
    catch_up_before_ = catch_up_;
    has_waited_ = waits_;
    exceeds_capacity_ = false;
    has_slid_ = false;
    rubbed_m_ = 0.0;
    lists_ = 0;
    steps_ = 0;
    path_.clear();
    path_.push_back(position_);
}

/// True if a further list of triangles would help. Without data the proxy would end at the same
/// place.
bool Proxy::is_worth_going_on(Motion motion, std::span<const PlacedSurface> surfaces) const noexcept
{
    const bool is_cut =
        motion == Motion::ran_out || (motion == Motion::data_limited &&
                                      std::ranges::any_of(surfaces, [](const PlacedSurface& placed)
                                                          { return placed.surface->is_cut; }));
    return is_cut && lists_ < kListsPerFrame && steps_ < kProxySteps &&
           went_m() > kWorthAList * radius_;
}

void Proxy::see(const ProxyGoal& goal) noexcept
{
    rotation_ = goal.rotation;
    is_on_ = false; // The last frame may have ended without budget for a further list.
    if (goal.change == GoalChange::first)
    {
        position_ = goal.position_m;
    }
}

double Proxy::way_to_m(const ProxyGoal& goal) const noexcept
{
    const Vec3 way = goal.position_m - position_;
    const double inward = -way.dot(normal_);
    if (!in_contact_ || inward <= 0.0)
    {
        return way.norm();
    }
    return (way + inward * normal_).norm() + kDipShare * inward;
}

/// Radius of the tool, or, if larger, kPointSkin quanta of the coarsest model.
double Proxy::find_radius(std::span<const PlacedSurface> surfaces) const noexcept
{
    double skin = 0.0;
    for (const PlacedSurface& placed : surfaces)
    {
        skin = std::max(skin, kPointSkin * placed.quantum_m * placed.pose->scale);
    }
    return std::max(spec_.radius_m, skin);
}

/// Distance that the proxy may move within the proven space; 0 or less: none.
double Proxy::free_travel(std::span<const PlacedSurface> surfaces, double clear_m) const noexcept
{
    double travel = clear_m - radius_;
    for (const PlacedSurface& placed : surfaces)
    {
        travel = std::min(travel, known(placed) - radius_);
    }
    return travel;
}

/// True if a surface is known less far than requested, and ends the proxy's travel.
bool Proxy::is_short_of(std::span<const PlacedSurface> surfaces, double travel) const noexcept
{
    return std::ranges::any_of(surfaces,
                               [&](const PlacedSurface& placed)
                               {
                                   const double known_m = known(placed);
                                   return known_m <= travel + radius_ &&
                                          known_m < placed.reach_m * (1.0 - kContactTolerance);
                               });
}

/// Moves the proxy: straight while no surface is near enough to block it, then among the triangles
/// in reach.
Proxy::Motion Proxy::follow(const Vec3& goal, double travel,
                            std::span<const PlacedSurface> surfaces) noexcept
{
    in_contact_ = false;
    held_by_.clear();
    double clear = travel;
    for (const PlacedSurface& placed : surfaces)
    {
        clear = std::min(clear, placed.surface->answer.lower_m * placed.pose->scale - radius_);
    }
    go_straight_on(goal, clear);
    Vicinity near(surfaces, anchor_, radius_ + travel, planes_left_);
    if (spec_.shading_m > 0.0)
    {
        normals_ = ForceShading(spec_.shading_m, surfaces, radius_ + travel);
    }
    const Motion motion = follow_among(near, surfaces, goal, travel);
    if (motion != Motion::at_rest && motion != Motion::over_constrained)
    {
        near.stand_at(position_ - anchor_, normal_);
        hold_ = feel_at(near, surfaces, goal - position_, kNearlyTouching * radius_).hold;
    }
    in_contact_ = hold_.touches;
    TACTUS_ASSERT(!in_contact_ || hold_.depth_m > 0.0); // Sums of the hold are divided by it.
    slides_ = has_slid_ && in_contact_;
    keep_clearances(surfaces, &near);
    planes_left_ = near.planes_left();
    normals_ = {};
    return motion;
}

void Proxy::go_straight_on(const Vec3& goal, double clear) noexcept
{
    const Vec3 way = goal - position_;
    const double length = way.norm();
    if (clear > kLeastStep * radius_ && length > 0.0)
    {
        position_ += way * std::min(1.0, clear / length);
        path_.push_back(position_);
    }
}

Proxy::Motion Proxy::follow_among(Vicinity& near, std::span<const PlacedSurface> surfaces,
                                  const Vec3& goal, double travel) noexcept
{
    const double least_step = kLeastStep * radius_;
    for (;;)
    {
        if (near.is_spent())
        {
            return Motion::out_of_planes;
        }
        ++steps_;
        TACTUS_ASSERT(steps_ <= kProxySteps);
        near.stand_at(position_ - anchor_, normal_);
        // `room` is the distance that is free of unlisted and uncertified triangles.
        const double moved = (position_ - anchor_).norm();
        const double room = std::min(near.reach_m() - radius_, travel) - moved;
        hold_ = hold_at(near, surfaces, goal - position_, room);
        const double length = hold_.motion.norm();
        if (hold_.is_over_constrained)
        {
            return Motion::over_constrained;
        }
        if (length <= (hold_.rubs || hold_.is_smooth ? kSlipShare * radius_ : least_step))
        {
            return Motion::at_rest;
        }
        if (steps_ == kProxySteps)
        {
            return Motion::out_of_steps;
        }
        if (room <= least_step)
        {
            return travel - moved <= least_step ? Motion::data_limited : Motion::ran_out;
        }
        position_ += hold_.motion;
        rubbed_m_ += hold_.touches ? length : 0.0;
        path_.push_back(position_);
    }
}

Proxy::Hold Proxy::hold_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                           const Vec3& wanted, double room) noexcept
{
    Touch touch = feel_at(near, surfaces, wanted, kTouchShare * radius_);
    Hold& hold = touch.hold;
    const bool may_go = room > kLeastStep * radius_;
    StepPlanes& step = touch.planes;
    const std::size_t touching = step.planes.size();
    for (const std::uint32_t face : held_by_)
    {
        if (!step.planes.full() && !step.has(face))
        {
            step.add(face, near.half_space(face, radius_));
        }
    }
    const bool is_same = !hold.rubs && step.planes.size() == touching;
    const Vec3 let = hold.rubs ? Vec3(touch.wanted - touch.kept) : touch.wanted;
    NearestMotion<3> found = is_same ? touch.held : search(near, step, let);
    if (may_go)
    {
        found = nearest_free_motion(near, let, radius_, room, step, found);
    }
    held_by_.clear();
    for (const std::uint32_t plane : found.held_by)
    {
        held_by_.push_back(step.faces[plane]);
    }
    hold.motion = found.motion;
    hold.is_over_constrained = !found.is_feasible;
    if (may_go && !hold.touches &&
        std::ranges::any_of(surfaces,
                            [](const PlacedSurface& placed) { return rubs(*placed.material); }))
    {
        hold.motion = go_to_contact(near, within(wanted, room), hold.motion);
    }
    return hold;
}

/// Finds the contacts of the proxy at its place, within `gap_m`, with their push and friction.
Proxy::Touch Proxy::feel_at(Vicinity& near, std::span<const PlacedSurface> surfaces,
                            const Vec3& wanted, double gap_m) noexcept
{
    std::array<std::uint32_t, kMaxHalfSpaces> faces; // NOLINT(*-member-init): it is written first.
    const Vicinity::Listed listed = near.list_within(radius_ + gap_m, faces);
    exceeds_capacity_ = exceeds_capacity_ || !listed.is_all;
    Touch touch;
    for (const std::uint32_t face : std::span(faces).first(listed.count))
    {
        touch.planes.add(face, near.half_space(face, radius_));
    }
    touch.wanted = wanted;
    touch.held = search(near, touch.planes, wanted);
    const Vec3 pressed = touch.held.motion - wanted;
    const ForceShading::Felt felt =
        normals_.are_on() ? hold_smoothly(near, touch, pressed) : ForceShading::Felt{};
    const NearestMotion<3>& held = touch.held;
    Hold& hold = touch.hold;
    const auto surface_of = [&](std::size_t i) -> const PlacedSurface&
    { return surfaces[near.surface_of(touch.planes.faces[held.held_by[i]])]; };
    for (std::size_t i = 0; i < held.held_by.size(); ++i)
    {
        press(hold, surface_of(i), held.reactions[i] * touch.planes.planes[held.held_by[i]].normal);
    }
    if (!hold.touches)
    {
        return touch;
    }
    if (felt.raised_m > 0.0)
    {
        press_smoothly(hold, felt, pressed);
    }
    if (hold.has_texture)
    {
        for (std::size_t i = 0; i < held.held_by.size(); ++i)
        {
            press_into_texture(hold, surface_of(i), pressed, held.reactions[i] / hold.depth_m);
        }
        hold.bump_m = along_all(hold.bump_m, touch.planes, held.held_by.view());
    }
    if (const double push_sq = hold.push_n.squaredNorm(); push_sq > kLeastPush_n * kLeastPush_n)
    {
        normal_ = hold.push_n / std::sqrt(push_sq);
    }
    if (hold.rubs)
    {
        touch.kept = rub(hold, held.motion - touch.planes.way_out(kContactTolerance * radius_));
    }
    return touch;
}

/// Raises the goal towards the surface, along the shaded normal; the planes then hold the raised
/// goal.
ForceShading::Felt Proxy::hold_smoothly(Vicinity& near, Touch& touch,
                                        const Vec3& pressed) const noexcept
{
    const double depth_m = pressed.norm();
    if (!touch.held.is_feasible || !(depth_m > 0.0))
    {
        return {};
    }
    const double moved_m = (position_ - anchor_).norm();
    ForceShading::Felt felt =
        normals_.at({position_, pressed / depth_m, radius_, moved_m}, depth_m);
    near.use(felt.looks);
    const Vec3 raised = touch.wanted + felt.raise_m;
    const NearestMotion<3> held = search(near, touch.planes, raised);
    if (held.held_by.empty())
    {
        return {}; // The raised goal is in front of all planes, so the original goal is kept.
    }
    touch.wanted = raised;
    touch.held = held;
    return felt;
}

/// Adds to the hold the push and energy that raising the goal took away.
void Proxy::press_smoothly(Hold& hold, const ForceShading::Felt& felt, const Vec3& pressed) noexcept
{
    const double depth_m = pressed.norm();
    TACTUS_ASSERT(depth_m > felt.raised_m); // ForceShading raises a goal by less than its depth.
    const double whole = depth_m / (depth_m - felt.raised_m);
    hold.static_m *= whole;
    hold.dynamic_m *= whole;
    hold.push_n += hold.stiffness / hold.depth_m * (felt.raise_m + felt.push_m / depth_m * pressed);
    hold.stiffening *= felt.stiffening;
    hold.is_smooth = true;
}

/// Adds a touching plane to the hold. `depth` is the vector from the goal to the plane, along its
/// normal.
void Proxy::press(Hold& hold, const PlacedSurface& placed, const Vec3& depth) const noexcept
{
    const Material& material = *placed.material;
    const double length = depth.norm();
    const double stiffness = std::min(spec_.stiffness_n_per_m, material.stiffness_n_per_m);
    hold.object = length >= hold.deepest_m ? placed.object : hold.object;
    hold.deepest_m = std::max(hold.deepest_m, length);
    hold.touches = hold.touches || length > 0.0;
    hold.push_n += stiffness * depth;
    hold.depth_m += length;
    hold.stiffness += stiffness * length;
    hold.static_m += material.static_friction * length;
    hold.dynamic_m += material.dynamic_friction * length;
    hold.damping += material.damping_n_s_per_m * length;
    hold.viscosity += material.viscosity_n_s_per_m * length;
    hold.stiffening += Texture::stiffening(material) * length;
    hold.has_texture = hold.has_texture || material.texture_height_m > 0.0;
    hold.rubs = hold.rubs || rubs(material);
    hold.velocity += placed.memory->velocity_m_per_s * length;
}

/// Adds the texture of a touching surface to the hold. `pressed` is the vector of the whole depth,
/// `share` the part of this surface.
void Proxy::press_into_texture(Hold& hold, const PlacedSurface& placed, const Vec3& pressed,
                               double share) const noexcept
{
    const double depth_m = pressed.norm();
    if (depth_m > 0.0)
    {
        const Texture texture = Texture::at(*placed.material, *placed.pose, position_, depth_m);
        const double stiffness = share * hold.stiffness / hold.depth_m;
        hold.push_n += stiffness * texture.push_m / depth_m * pressed;
        hold.bump_m += share * texture.slope_m;
    }
}

/// Motion straight to the contact, at which friction begins: up to the first face that it enters.
Vec3 Proxy::go_to_contact(Vicinity& near, const Vec3& wanted, const Vec3& motion) const noexcept
{
    StaticVector<std::uint32_t, kStepRounds> passed;
    double share = 1.0;
    while (const auto entered = near.find_entered(wanted * share, radius_, passed.view()))
    {
        if (!passed.try_push_back(*entered))
        {
            share = std::min(share, near.free_share(wanted, radius_));
            break;
        }
        share = std::min(share, near.share_before(*entered, wanted, radius_));
    }
    if (near.is_spent())
    {
        // The first entered face is unknown, so the motion proven without friction is kept.
        return motion;
    }
    const Vec3 straight = wanted * share;
    return !passed.empty() && straight.norm() > kLeastStep * radius_ ? straight : motion;
}

/// Coulomb's cone: the tool sticks while its pull, `slip` less the textures' displacement, is
/// within the static cone. Otherwise it slides until the pull is within the dynamic cone. A viscous
/// surface resists sliding as an implicit damper, by viscosity x displacement / time; the
/// displacement is that in contact in this frame. Returns the part of the slip that these hold
/// back.
Vec3 Proxy::rub(Hold& hold, const Vec3& slip) noexcept
{
    const Vec3 pull = slip - hold.bump_m;
    const double length = pull.norm();
    const double stiffness = hold.stiffness / hold.depth_m;
    const bool slips = length > (slides_ ? hold.dynamic_m : hold.static_m) + kSlipShare * radius_;
    slides_ = slides_ || slips;
    has_slid_ = has_slid_ || slips;
    double most = slips || slides_ ? hold.dynamic_m : hold.static_m;
    if (slides_ && hold.viscosity > 0.0)
    {
        const double viscosity = hold.viscosity / hold.depth_m;
        const double held = stiffness * elapsed_s_;
        most = (held * most + viscosity * (rubbed_m_ + length)) / (held + viscosity);
    }
    const Vec3 kept = hold.bump_m + (length > most ? Vec3(pull * (most / length)) : pull);
    hold.drag_n = -stiffness * kept;
    return kept;
}

/// Stores the proxy's clearance from each object's surface.
void Proxy::keep_clearances(std::span<const PlacedSurface> surfaces, const Vicinity* near) noexcept
{
    const double moved = (position_ - anchor_).norm();
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
    {
        const DistanceAnswer& answer = surfaces[i].surface->answer;
        const double scale = surfaces[i].pose->scale;
        double clearance_m = answer.lower_m * scale - moved;
        if (near != nullptr)
        {
            const Vec3 place = position_ - anchor_;
            const double known = answer.certified_radius_m * scale - moved;
            const double listed =
                std::min(near->reach_m() - place.norm(), near->bound_of_surface(i, place));
            clearance_m = std::max(clearance_m, std::min(known, listed));
        }
        surfaces[i].memory->clearance_m = clearance_m;
    }
}

void Proxy::carry(std::span<const NearObject> objects, double elapsed_s) noexcept
{
    was_overrun_ = false;
    if (objects.empty())
    {
        return;
    }
    TACTUS_ASSERT(elapsed_s > 0.0);
    const auto along = [this](const NearObject& object)
    { return to_world(*object.now, to_model(*object.before, position_)); };
    for (const NearObject& object : objects)
    {
        if (object.has_moved())
        {
            object.memory->velocity_m_per_s = (along(object) - position_) / elapsed_s;
        }
    }
    const Carried<Vec3> target =
        carried(position_, objects, in_contact_ ? hold_.object : kNoObject, along,
                [&](const Vec3& place) { return is_overrun(place, objects); });
    was_overrun_ = target.is_overrun;
    position_ = target.place;
}

void Proxy::forget(std::uint32_t object) noexcept
{
    hold_.object = hold_.object == object ? kNoObject : hold_.object;
}

/// True if the proxy could change the side of a surface by moving to `target` while the objects
/// move.
bool Proxy::is_overrun(const Vec3& target, std::span<const NearObject> objects) const noexcept
{
    const double goes_m = (target - position_).norm();
    if (goes_m > 0.0 && goes_m >= clear_m_ - went_m())
    {
        return true; // The motion exceeds the clearance from all objects without a surface here.
    }
    return std::ranges::any_of(
        objects,
        [&](const NearObject& object)
        {
            const Vec3 before = to_model(*object.before, position_);
            const double way = (to_model(*object.now, target) - before).norm();
            const double way_m = way * std::max(object.before->scale, object.now->scale);
            const bool moves = way_m > 4.0 * pose_rounding_m(*object.now, target, 0.0);
            return moves && way_m * (1.0 + kContactTolerance) >= object.memory->clearance_m;
        });
}

/// Force of the spring, friction, and damping across the surface; the damping never turns a push
/// into a pull.
Vec3 Proxy::force(const ProxyGoal& goal) const noexcept
{
    const double inward = (hold_.velocity / hold_.depth_m - goal.velocity_m_per_s).dot(normal_);
    const double push = hold_.push_n.norm();
    const double damped = std::max(-push, hold_.damping / hold_.depth_m * inward);
    return clamped(hold_.push_n + damped * normal_ + hold_.drag_n);
}

/// Returns the force with a limited catch-up. Motion of the device relative to the object may
/// change the force by stiffness x displacement.
Vec3 Proxy::caught_up(const ProxyGoal& goal) noexcept
{
    const Vec3 velocity = goal.velocity_m_per_s - hold_.velocity / hold_.depth_m;
    const double by_device_n = hold_.stiffness / hold_.depth_m * velocity.norm() * goal.elapsed_s;
    const double rate = std::min(kCatchUp_n_per_s, kCatchUpShare_per_s * spec_.force_max_n);
    return catch_up_.next(
        {force(goal), by_device_n, spec_.force_max_n, rate, goal.elapsed_s, has_waited_});
}

/// Force of a halted or over-constrained proxy: along the last normal, never pulling.
Vec3 Proxy::held_force(const Vec3& goal) const noexcept
{
    const double push = spec_.stiffness_n_per_m * (position_ - goal).dot(normal_);
    return clamped(normal_ * std::max(0.0, push));
}

Vec3 Proxy::clamped(const Vec3& force) const noexcept
{
    const double norm = force.norm();
    return norm > spec_.force_max_n ? Vec3(force * (spec_.force_max_n / norm)) : force;
}

} // namespace tactus
