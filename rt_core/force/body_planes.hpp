// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/symmetric_factor.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Contacts of a body that friction may hold: each takes four planes of kMaxHalfSpaces.
inline constexpr std::size_t kTiltedContacts = kMaxHalfSpaces / 4;

/// Where a body may touch; world frame.
struct BodyTouch
{
    std::uint32_t surface{0}; ///< Of the step's.
    Vec3 on_tool_m{0.0, 0.0, 0.0};
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< From the surface to the tool.
    bool is_face{false};        ///< It touches within a face, whose own normal that is.
};

/// How the surface at a touch feels.
struct BodyGrip
{
    double stiffness_n_per_m{0.0};
    double friction{0.0}; ///< The coefficient that holds now.
    double dynamic{0.0};  ///< While it slides.
    double damping_n_s_per_m{0.0};
    /// Of the way along the surface in this frame, as a share of the stretch that holds it back.
    double viscous{0.0};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0}; ///< Of the surface.
    Vec3 way_m{0.0, 0.0, 0.0};            ///< That the surface went, and friction takes along.
    Vec3 frame_way_m{0.0, 0.0, 0.0};      ///< That it went in all of the frame.
};

/// What pushes a body: `reaction` x `normal` is the motion that it holds back.
struct BodyPush
{
    std::uint32_t touch{0};
    Motion<6> normal{Motion<6>::Zero()};
    double reaction{0.0};
};

/// The motion that planes and friction let a body make, and what pushes it there.
struct BodyMotion
{
    Motion<6> motion{Motion<6>::Zero()};
    StaticVector<BodyPush, 6> pushes;
    bool slides{false};      ///< Against friction.
    bool sticks{false};      ///< Friction holds it where it pushes.
    bool is_squeezed{false}; ///< No motion was allowed by all planes.
};

/// The planes of one step of a body, and the motion that they and Coulomb's friction allow.
///
/// Motions are six numbers: a way in metres, and a rotation vector times the arm. Their length is
/// the coupling's energy, so the nearest motion is where its springs come to rest.
///
/// Friction (Moreau 1966): the plane of a contact is tilted into four, whose normals are the
/// corners of its friction pyramid: normal +- coefficient x tangent, the first tangent along the
/// way that the hand wants to go there. The nearest motion that tilted planes allow is none where
/// the hand's pull lies within the cone that they span, all contacts together, and only there: the
/// body sticks. Where it slides, tilted planes would lift it; so their friction is added to the
/// wanted motion and the plain planes answer, once more with the friction that belongs to their
/// pressure.
///
/// Viscosity: where the body slides, each contact that presses is a damper, implicit as in Proxy. A
/// motion then costs what they take of it beside the springs' energy, and the nearest one is found
/// in that metric: the planes and what is wanted are taken there and back by its Cholesky factor.
///
/// Seams: where a tool stands over one face, the next one seems to lean against it, since its
/// nearest point is the edge that both share. Such a plane would let the tool go half of the way to
/// the edge at most, and so drag at what slides. It is left out where touches on the first face's
/// plane hold up that place of the tool from all sides.
///
/// Scratch, too large for a frame's stack: 23 KiB. Haptic thread. Cost: 0.7 to 5 us without
/// friction, at most 10 us more with it.
class BodyPlanes
{
public:
    /// Empties it for a step of a tool that is `place_m` there: `arm_m` is the metric's, `size_m`
    /// the tool's own. `gone` is the motion that it has made in the frame's steps before.
    void begin(const Vec3& place_m, double arm_m, double size_m, double radius_m,
               const Motion<6>& gone) noexcept TACTUS_NONBLOCKING;
    /// Where there is no room, what holds back least goes; then it is crowded.
    void add(const BodyTouch& touch, const BodyGrip& grip) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] BodyMotion nearest(const Motion<6>& wanted) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool is_crowded() const noexcept { return is_crowded_; }
    [[nodiscard]] const BodyTouch& touch(std::uint32_t i) const noexcept { return touches_[i]; }
    [[nodiscard]] const BodyGrip& grip(std::uint32_t i) const noexcept { return grips_[i]; }
    /// Of a touch: from the tool's place to where its outside meets the surface.
    [[nodiscard]] Vec3 lever_m(std::uint32_t i) const noexcept TACTUS_NONBLOCKING;

private:
    /// One corner of a contact's pyramid.
    struct Tilt
    {
        std::uint32_t touch{0};
        Motion<6> drag{Motion<6>::Zero()}; ///< Coefficient x tangent.
    };
    using Chosen = StaticVector<std::uint32_t, kTiltedContacts>;

    /// A plane of faces that the tool touches, and where it does: a mesh has many faces in one.
    struct Ground
    {
        using Heights = std::array<double, 8>; ///< Along directions in the plane.

        std::uint32_t face; ///< The touch of the nearest of these faces.
        Vec3 first;         ///< An axis in the plane.
        Vec3 second;        ///< The other one.
        Heights high_m{};   ///< Where the tool points that touch it end, from the tool's place,
        Heights low_m{};    ///< and where they begin.

        Ground(std::uint32_t nearest, const Vec3& normal) noexcept;
        [[nodiscard]] Heights heights(const Vec3& point_m) const noexcept;
        void support(const Vec3& point_m) noexcept;
        [[nodiscard]] bool is_among_supports(const Vec3& point_m, double off_m) const noexcept;
    };
    /// The tool catches on the seams of further ones.
    static constexpr std::size_t kMaxGrounds = 8;
    using Grounds = StaticVector<Ground, kMaxGrounds>;

    [[nodiscard]] Grounds grounds() const noexcept;
    [[nodiscard]] bool is_seam(std::size_t plane, const Ground& ground) const noexcept;
    void leave_out_seams() noexcept;
    void replace(std::size_t plane, const HalfSpace<6>& space, const BodyTouch& touch,
                 const BodyGrip& grip) noexcept;
    [[nodiscard]] double apart_sq(const HalfSpace<6>& a, const HalfSpace<6>& b) const noexcept;
    [[nodiscard]] NearestMotion<6> plain(const Motion<6>& wanted, bool& is_squeezed) noexcept;
    [[nodiscard]] Chosen choose(const NearestMotion<6>& plain) const noexcept;
    void tilt(const Chosen& chosen, const Motion<6>& wanted) noexcept;
    void tilt(std::uint32_t touch, const Motion<6>& wanted) noexcept;
    [[nodiscard]] bool is_stuck(const NearestMotion<6>& tilted) const noexcept;
    [[nodiscard]] BodyMotion stuck(const NearestMotion<6>& tilted) noexcept;
    [[nodiscard]] BodyMotion sliding(const NearestMotion<6>& tilted,
                                     const Motion<6>& wanted) noexcept;
    /// What dampers take of a motion: metric - 1 of it, and what they take of the way before.
    struct Viscosity
    {
        SymmetricFactor factor; ///< Of the metric.
        Motion<6> gone{Motion<6>::Zero()};
    };

    [[nodiscard]] bool drags(const NearestMotion<6>& held, std::size_t i) const noexcept;
    [[nodiscard]] std::optional<Viscosity>
    viscosity_of(const NearestMotion<6>& held) const noexcept;
    void rub(const NearestMotion<6>& held, const Motion<6>& wanted, const Motion<6>& drag,
             BodyMotion& answer) noexcept;
    [[nodiscard]] double share_of(const NearestMotion<6>& plain, double most) const noexcept;

    StaticVector<HalfSpace<6>, kMaxHalfSpaces> spaces_;
    StaticVector<BodyTouch, kMaxHalfSpaces> touches_;
    StaticVector<BodyGrip, kMaxHalfSpaces> grips_;
    StaticVector<HalfSpace<6>, kMaxHalfSpaces> tilted_; ///< Corners of pyramids, then plain ones.
    StaticVector<Tilt, kMaxHalfSpaces> tilts_;          ///< Of the first of those.
    StaticVector<std::uint32_t, kMaxHalfSpaces> untilted_; ///< Touches of the others.
    Vec3 place_m_{0.0, 0.0, 0.0};
    Motion<6> gone_{Motion<6>::Zero()};
    double arm_m_{1.0};
    double turn_weight_{1.0}; ///< Of turns where planes are compared: the tool's size is the arm.
    double radius_m_{0.0};
    bool is_crowded_{false};
};

} // namespace tactus
