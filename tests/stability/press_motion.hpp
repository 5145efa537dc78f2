// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"
#include "tests/shared/test_model.hpp"

#include <cstdint>
#include <optional>

namespace tactus::test
{

/// Hand that presses a sphere 0.5 to 1 mm into an object. Activities are random, each for some
/// hundred frames of 1 ms: it rests, slides at 0.02 to 0.1 diag/s, taps, or lifts off and descends
/// elsewhere. Computed from the full mesh alone, in the model frame; lengths of the world are
/// divided by the object's scale.
class PressMotion
{
public:
    /// Starts with a radius in the world. All arguments must outlive the motion.
    PressMotion(const TestModel& model, const FaceTree& tree, double radius_m, double scale,
                Random& random);

    [[nodiscard]] Vec3 next();
    /// Name of the present activity, for a report.
    [[nodiscard]] const char* activity() const;

private:
    enum class Activity : std::uint8_t
    {
        hop, ///< First activity.
        rest,
        slide,
        tap,
    };

    void begin();
    [[nodiscard]] double wanted_depth_m();
    void slide_from(const Vec3& place_m, double speed_diag_per_s);

    const TestModel& model_;
    const FaceTree& tree_;
    double radius_m_;
    double scale_;
    Random& random_;
    std::optional<SurfaceSlide> slide_;
    Vec3 guide_m_{0.0, 0.0, 0.0}; ///< Centre of a sliding sphere; the goal is beside it.
    Vec3 normal_{0.0, 0.0, 1.0};  ///< Normal from the surface to that sphere.
    double depth_m_{0.0}; ///< Depth of the sphere in the surface, in the world; negative above it.
    double pressed_m_{0.0};
    double change_m_{0.0}; ///< Change of the depth in a frame.
    Activity activity_{Activity::hop};
    std::uint32_t frame_{0};
    std::uint32_t frames_left_{0};
};

} // namespace tactus::test
