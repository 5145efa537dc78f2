// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/force/external_force.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Any thread except the haptic one: values; their strings and vectors allocate.
namespace tactus
{

/// Encoding of a mesh as a model. Costs 10 to 20 us and about 480 bytes a face.
struct MeshOptions
{
    std::string unit{"m"}; ///< Unit of the mesh: m, cm, mm, in or inch.
    /// Diagonal in metres to which the mesh is scaled, for a mesh without a true size.
    std::optional<double> fit_diagonal_m{};
    bool is_centered{false}; ///< True: the middle of the mesh's box becomes the origin.
    std::string name{};      ///< Name of the model in messages. [default: file's name, or mesh-N]
    /// Called from time to time in add(), on its thread, with the share of the work done, 0 to 1.
    std::function<void(double share)> progress{};
};

/// Source of a model; made by the functions below. Nothing is read before World::add().
struct WorldModel
{
    enum class Kind : std::uint8_t
    {
        file,      ///< An .spm file.
        mesh_file, ///< A mesh file, encoded by add().
        mesh,      ///< A mesh in memory, encoded by add().
        published, ///< A model of a server.
    };
    Kind kind{Kind::file};
    std::string text{}; ///< Path, or NAME[@HASH or @SERVER].
    MeshOptions options{};
    std::vector<std::array<double, 3>> vertices{};
    std::vector<std::array<std::uint32_t, 3>> faces{};
};

/// Model of an .spm file, as spm_build writes it.
[[nodiscard]] WorldModel model_file(std::string path);
/// Mesh of a .ply, .obj, .stl or .off file.
[[nodiscard]] WorldModel mesh_file(std::string path, MeshOptions options = {});
/// Mesh in memory: positions in the options' unit, and faces counter-clockwise seen from outside.
[[nodiscard]] WorldModel mesh(std::vector<std::array<double, 3>> vertices,
                              std::vector<std::array<std::uint32_t, 3>> faces,
                              MeshOptions options = {});
/// Model of a server on WorldOptions::domain: NAME, NAME@HASH or NAME@SERVER.
[[nodiscard]] WorldModel published(std::string name);

/// Material of an object, with the ranges and defaults of `hrtc --material`.
struct MaterialOptions
{
    /// Stiffness, 1 to 3,000 N/m; the lower one of this and the tool's is used. [default: the
    /// tool's]
    std::optional<double> stiffness_n_per_m{};
    double static_friction{0.0}; ///< Coulomb coefficient at rest, 0 to 3.
    /// Coulomb coefficient of a sliding tool, at most the static one. [default: the static one]
    std::optional<double> dynamic_friction{};
    double damping_n_s_per_m{0.0};   ///< Damping normal to the surface, 0 to 20.
    double viscosity_n_s_per_m{0.0}; ///< Drag along the surface, 0 to 20.
    double texture_height_m{0.0};    ///< Height of bumps; at most 1/32 of their length.
    double texture_length_m{0.0};    ///< Length of bumps, 1e-4 to 1.
};

struct ObjectOptions
{
    Pose pose{}; ///< Pose in the world; translation within 1e4 m, scale 1e-3 to 1e3.
    MaterialOptions material{};
    std::string name{}; ///< Name in messages. [default: the model's]
    /// Room of the model for faces that edits add, 0 to kMaxAddedFaces; part of
    /// WorldOptions::memory_mib, about 150 bytes each. The largest of its objects is used. 0 for a
    /// published model, whose server gives the room.
    std::uint32_t edit_faces{0};
};

/// Shape of a tool; made by the functions below. Lengths are 1e-5 to 1 m.
struct WorldTool
{
    std::string words{}; ///< Text as for `hrtc --tool`; empty: a hull or mesh given below.
    double radius_m{0.0};
    std::vector<std::array<double, 3>> corners{}; ///< Corners of a hull.
    std::optional<WorldModel> model{};            ///< Model of a mesh tool.
};

[[nodiscard]] WorldTool point();
[[nodiscard]] WorldTool sphere(double radius_m);
/// All points within the radius of an axis of this length along the tool's z.
[[nodiscard]] WorldTool capsule(double radius_m, double length_m);
/// Box of full edge lengths, with a radius added all round.
[[nodiscard]] WorldTool box(double x_m, double y_m, double z_m, double radius_m = 0.0);
/// Convex hull of corners in the tool's frame, at most kMaxHullVertices.
[[nodiscard]] WorldTool hull(std::vector<std::array<double, 3>> corners, double radius_m = 0.0);
/// The surface of a model of its own, which no object shows.
[[nodiscard]] WorldTool mesh_tool(WorldModel model, double radius_m = 0.0);
/// Tool by the words of `hrtc --tool`, such as "capsule:0.002,0.08".
[[nodiscard]] WorldTool tool(std::string words);

/// Properties of a device in the words of hrtc's options; empty: the default.
struct DeviceOptions
{
    std::string limits{}; ///< KEY=VALUE,... as for --device-limits; sim, dhd and program.
    std::string frame{};  ///< X,Y,Z[,RX,RY,RZ[,SCALE]] as for --device-frame; udp, dhd, plugin.
    std::string motion{}; ///< Motion of a simulated operator, as for --motion.
};

/// Device that moves a tool; made by the functions below.
struct WorldDevice
{
    std::string words{}; ///< Words as for `hrtc --device`; empty: `own`, or else the program.
    DeviceOptions options{};
    std::shared_ptr<HapticDevice> own{};
    bool is_program{false}; ///< True: no device; the program moves the hand.
};

/// Device by the words of `hrtc --device`: sim[:CLASS], udp[:[ADDRESS:]PORT], dhd[:INDEX],
/// replay:FILE or plugin:FILE[,WORDS]. udp, dhd and plugin need World::start(): a loop of one's own
/// has neither the machine's time nor a supervisor.
[[nodiscard]] WorldDevice device(std::string words, DeviceOptions options = {});
/// Device of the program's own class; not null, with an info() in range. The loop calls it as
/// HapticDevice says. If read() or write() blocks, the supervisor of World::start() brakes the
/// devices. The World lets go of it when its loop has ended.
[[nodiscard]] WorldDevice device(std::shared_ptr<HapticDevice> own);
/// No device: the program moves the hand by Hand::step() or Hand::hold(). `options.limits` are
/// those of the device to which the program passes the force; the default is a desk device of 8 N.
[[nodiscard]] WorldDevice by_program(DeviceOptions options = {});

/// Position in the world, and rotation as a unit quaternion x, y, z, w.
struct HandPose
{
    std::array<double, 3> position_m{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
};

/// Force of a program on one hand, besides that of surfaces. Called on the loop's thread once a
/// frame: it should neither wait nor allocate. If it throws, its force is zero in that frame.
/// Throws and calls longer than a period are counted (WorldCounts) and logged.
using HandForce = std::function<ExternalForce(const ToolState& hand, const ToolOutput& output)>;

struct HandOptions
{
    std::string payload{}; ///< KG[,X,Y,Z] as for --tool-mass. [default: none]
    std::string fixture{}; ///< Virtual fixture as for --fixture; not beside `force`.
    HandForce force{};
    /// carve:RATE as for --edit: the tool carves the models with room for edits that it presses on.
    /// Published models are carved by their servers. [default: none]
    std::string edit{};
};

} // namespace tactus
