// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"
#include "platform/scene/material_limits.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Largest number of objects with a line each; more are summed up in one line.
constexpr std::size_t kObjectsInLines = 4;
/// Ratio of a tool's diameter to the longest edge of the largest object, from which the tool's unit
/// of length is doubted.
constexpr double kMuchLarger = 3.0;

/// Box of an object in the world.
struct Surroundings
{
    Vec3 center_m;
    Vec3 edges_m; ///< Edges along the model's axes, scaled.

    [[nodiscard]] double radius_m() const { return 0.5 * edges_m.norm(); }
};

/// Coordinates, rounded to a tenth of a millimetre.
std::string text_of(const Vec3& place_m)
{
    const auto rounded = [](double value) { return std::round(1e4 * value) / 1e4 + 0.0; };
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", rounded(place_m.x()), rounded(place_m.y()),
                       rounded(place_m.z()));
}

std::vector<Surroundings> surroundings_of(const Controller& controller)
{
    std::vector<Surroundings> all;
    for (std::size_t i = 0; i < controller.objects().size(); ++i)
    {
        const ServedModel& model = controller.models()[controller.objects()[i].model.value];
        const ModelHeader header = ModelHeader::parse(model.header).value();
        const auto& extent = header.fields().extent_quanta;
        const Vec3 half_m =
            0.5 * static_cast<double>(header.quantum_m()) * Vec3(extent[0], extent[1], extent[2]);
        const ObjectPose pose = model_pose(controller.poses()[i], header.origin_m());
        all.push_back({to_world(pose, half_m), 2.0 * pose.scale * half_m});
    }
    return all;
}

/// Name of the object's model, with the object's own name if a scene gives it one.
std::string name_of(const Options& options, const Controller& controller, std::size_t object)
{
    const std::string& model = controller.models()[controller.objects()[object].model.value].name;
    const std::string own = object < options.objects.size() ? options.objects[object].name : "";
    return own.empty() || own == model ? model : fmt::format("{} ({})", own, model);
}

/// Text on those of `objects` that have a default place or material while another object has a
/// given one; empty without any.
std::string defaults_of(const Options& options, std::span<const PlacedObject> objects)
{
    const auto left_by = [&](bool PlacedObject::*given) -> std::string
    {
        const auto left = std::ranges::count(objects, false, given);
        const bool is_mixed = left > 0 && std::ranges::any_of(options.objects, given);
        return !is_mixed ? "" : objects.size() == 1 ? "; no" : fmt::format("; {} without", left);
    };
    const std::string places = left_by(&PlacedObject::has_place);
    const std::string materials = left_by(&PlacedObject::has_material);
    return (places.empty() ? "" : places + " --place: placed as in the file") +
           (materials.empty()
                ? ""
                : materials + " --material: stiffness of --stiffness, no friction or texture");
}

/// Options of an object, as a span of one; empty for an object of a server's scene.
std::span<const PlacedObject> placed_object(const Options& options, std::size_t object)
{
    return object < options.objects.size() ? std::span(options.objects).subspan(object, 1)
                                           : std::span<const PlacedObject>();
}

std::string object_lines(const Options& options, const Controller& controller,
                         const std::vector<Surroundings>& objects)
{
    std::string text;
    for (std::size_t i = 0; i < objects.size() && objects.size() <= kObjectsInLines; ++i)
    {
        const Vec3& edges_m = objects[i].edges_m;
        text += fmt::format("{:<12}{}: {:.4g} x {:.4g} x {:.4g} m, around {}{}\n", "touches",
                            name_of(options, controller, i), edges_m.x(), edges_m.y(), edges_m.z(),
                            text_of(objects[i].center_m),
                            defaults_of(options, placed_object(options, i)));
    }
    if (objects.size() > kObjectsInLines)
    {
        Vec3 low_m = objects.front().center_m;
        Vec3 high_m = low_m;
        for (const Surroundings& object : objects)
        {
            low_m = low_m.cwiseMin(object.center_m);
            high_m = high_m.cwiseMax(object.center_m);
        }
        text = fmt::format("{:<12}{} objects of {}, centres from {} to {}{}\n", "touches",
                           objects.size(), counted(controller.models().size(), "model"),
                           text_of(low_m), text_of(high_m), defaults_of(options, options.objects));
    }
    return text;
}

/// Text on the number of objects in the device's reach; if there is none, on the distance of the
/// nearest.
std::string reach_of(const Options& options, const ToolSetup& tool, const Controller& controller,
                     const std::vector<Surroundings>& objects)
{
    const DeviceInfo& device = tool.device->info();
    const auto& centre = device.workspace_centre_world_m;
    const Vec3 centre_m(centre[0], centre[1], centre[2]);
    std::vector<double> beyond_m;
    for (const Surroundings& object : objects)
    {
        beyond_m.push_back((object.center_m - centre_m).norm() - object.radius_m() -
                           device.workspace_radius_m - tool.operator_radius_m);
    }
    const auto reached =
        std::ranges::count_if(beyond_m, [](double distance_m) { return distance_m <= 0.0; });
    if (reached > 0)
    {
        return counted(static_cast<std::uint64_t>(reached), "object") + " in reach";
    }
    if (objects.empty())
    {
        return "NO OBJECT IN REACH";
    }
    const auto nearest = std::ranges::min_element(beyond_m);
    return fmt::format(
        "NO OBJECT IN REACH: {} is {:.3g} m beyond the reach",
        name_of(options, controller, static_cast<std::size_t>(nearest - beyond_m.begin())),
        *nearest);
}

/// Note on a tool that is kMuchLarger times as large as all objects or more; else empty.
std::string size_note(const ToolSetup& tool, const std::vector<Surroundings>& objects)
{
    double largest_m = 0.0;
    for (const Surroundings& object : objects)
    {
        largest_m = std::max(largest_m, object.edges_m.maxCoeff());
    }
    const double times = largest_m > 0.0 ? 2.0 * tool.spec.radius_m / largest_m : 0.0;
    return times < kMuchLarger
               ? std::string()
               : fmt::format(", {:.2g} TIMES AS LARGE as the largest object", times);
}

/// Text of a count above 0, rounded to two digits, such as 27000.
std::string about(double count)
{
    const double step = std::pow(10.0, std::max(0.0, std::floor(std::log10(count)) - 1.0));
    return fmt::format("{:.0f}", std::round(count / step) * step);
}

/// Note on a tool below which lie more faces than a frame searches or the pools can hold; else
/// empty. The object with most faces below the tool counts.
std::string footprint_note(const ToolSetup& tool, const Controller& controller,
                           const std::vector<FaceDensity>& densities)
{
    Footprint most;
    std::string name;
    for (std::size_t i = 0; i < controller.objects().size(); ++i)
    {
        const std::size_t model = controller.objects()[i].model.value;
        const Footprint here =
            footprint_of(tool.spec, densities[model], controller.poses()[i].scale);
        name = here.faces > most.faces ? controller.models()[model].name : name;
        most = here.faces > most.faces ? here : most;
    }
    const double room = pool_capacities(controller.setup()).faces;
    std::string limit;
    if (most.faces > kMaxLocalTriangles)
    {
        limit = fmt::format("but a frame searches {}", kMaxLocalTriangles);
    }
    else if (most.kept > room)
    {
        const double pool_mib = static_cast<double>(controller.pool_bytes()) / 0x1p20;
        limit = fmt::format("but the pools hold {} of {} needed there; --pool-mib {:.0f} is enough",
                            about(room), about(most.kept), std::ceil(pool_mib * most.kept / room));
    }
    const bool is_tolerant = controller.setup().force_tolerance_n > 0.0;
    return limit.empty()
               ? std::string()
               : fmt::format("{:<12}covers about {} faces of {}, {}: the tool {}\n", "",
                             about(most.faces), name, limit,
                             is_tolerant ? "touches a coarser surface, with proven bounds"
                                         : "MAY BE DATA-LIMITED without --force-tolerance");
}

/// Text on the term of the stiffness limit that makes the wall softer than asked.
std::string softened_by(const ToolSetup& tool, double damping_n_s_per_m, double asked_n_per_m)
{
    const DeviceLimits& device = tool.device->info().limits;
    const double period_s = tool.conditioner.period_s;
    const StiffnessLimits limits = stiffness_limits(device, period_s, damping_n_s_per_m);
    const double least_n_per_m = std::min(limits.sampling_n_per_m, limits.quantisation_n_per_m);
    const std::string of_surface =
        damping_n_s_per_m > 0.0 ? fmt::format(" minus {:.3g} of the surface", damping_n_s_per_m)
                                : "";
    const std::string cause =
        limits.device_n_per_m < least_n_per_m ? "the limit of the device"
        : limits.quantisation_n_per_m < limits.sampling_n_per_m
            ? fmt::format("its friction of {:.3g} N and position steps of {:.3g} mm",
                          device.friction_n, 1e3 * device.quantum_m)
            : fmt::format("its damping of {:.3g} N s/m{}, delay of {:.3g} ms and the period of "
                          "{:.3g} ms",
                          device.damping_n_s_per_m, of_surface, 1e3 * device.delay_s,
                          1e3 * period_s);
    return fmt::format(" instead of {:.4g} N/m because of {}", asked_n_per_m, cause);
}

std::string tool_line(const Options& options, const ToolSetup& tool, const Controller& controller,
                      const std::vector<Surroundings>& objects)
{
    const DeviceInfo& device = tool.device->info();
    const auto& centre = device.workspace_centre_world_m;
    const double asked = options.stiffness_n_per_m;
    double damping_n_s_per_m = 0.0; // The largest damping gives the lowest limit.
    for (const PlacedObject& object : options.objects)
    {
        damping_n_s_per_m = std::max(damping_n_s_per_m, object.material.damping_n_s_per_m);
    }
    const double stiffest =
        std::min(tool.limits.stiffness_n_per_m,
                 stiffness_limit(device.limits, tool.conditioner.period_s, damping_n_s_per_m));
    const std::string wall =
        stiffest < kSoftestFelt_n_per_m
            ? "NOTHING WILL BE FELT: the damping, friction and rate of the device allow no stiff "
              "contact"
            : fmt::format("stiffness up to {:.4g} N/m{}", stiffest,
                          stiffest < asked ? softened_by(tool, damping_n_s_per_m, asked) : "");
    const std::string where = device.workspace_radius_m < kPoseReachMax_m
                                  ? fmt::format("{:.3g} m around {}", device.workspace_radius_m,
                                                text_of(Vec3(centre[0], centre[1], centre[2])))
                                  : "anywhere"; // A simulated operator that follows an object.
    return fmt::format("{:<12}{} on {}, {}: {}{}; {}\n", "tool", tool.shape, device.name, where,
                       reach_of(options, tool, controller, objects), size_note(tool, objects),
                       wall);
}

} // namespace

std::string start_lines(const Options& options, const Controller& controller)
{
    const std::vector<Surroundings> objects = surroundings_of(controller);
    std::vector<FaceDensity> densities;
    std::ranges::transform(controller.models(), std::back_inserter(densities), face_density);
    std::string text = object_lines(options, controller, objects);
    for (const ToolSetup& tool : controller.tools())
    {
        text += tool_line(options, tool, controller, objects) +
                footprint_note(tool, controller, densities);
    }
    return text;
}

} // namespace tactus::hrtc
