// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Models that are edited while tools move over them, against brute force over the list of their
/// faces: random shapes, tools, edits, budgets and links.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/edited_soup.hpp"
#include "tests/shared/exact_meet.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"
#include "tests/shared/shape_oracle.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/shared/trial_figures.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/pop_through_trial.hpp"
#include "tests/stability/random_motion.hpp"
#include "tests/stability/trial_terms.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kSettledFrames = 4'000; ///< Most frames until an answer is exact.
constexpr std::uint32_t kRestingFrames = 20;    ///< Frames outside the model at the start.
constexpr double kForceLimitRounding_n = 1e-9;

// --- Tools ---------------------------------------------------------------------------------------

enum class TrialTool : std::uint8_t
{
    sphere,
    measuring, ///< Query-only sphere that measures at any range.
    capsule,
    box,
    hull,
    mesh,
};
constexpr std::array<const char*, 6> kTrialToolNames{"sphere", "measuring", "capsule",
                                                     "box",    "hull",      "mesh"};

const TestModel& mesh_of_tool()
{
    return test_model("edits-tool",
                      scaled_mesh(make_shape(Shape::bumpy_sphere, 500).value(), 1.0 / 12.0), 100);
}

SolidCore solid_of(TrialTool tool)
{
    switch (tool)
    {
    case TrialTool::capsule:
        return segment_core("capsule", {{-0.01, 0.0, 0.0}, {0.01, 0.0, 0.0}}, 0.003);
    case TrialTool::box:
        return box_core("box", {0.01, 0.006, 0.003}, 0.001);
    case TrialTool::hull:
        return spike_core(0.001);
    case TrialTool::mesh:
        return mesh_core("mesh", mesh_of_tool(), 0.001);
    case TrialTool::sphere:
    case TrialTool::measuring:
        break;
    }
    return {"sphere", PointCore{}, {}, 0.0};
}

/// Distances of a placed convex core from faces, face by face.
class PlacedSolid
{
public:
    PlacedSolid(const SolidCore& solid, const Similarity& place)
        : faces_(solid.faces), is_segment_(std::holds_alternative<Segment>(solid.core))
    {
        for (Triangle& face : faces_)
        {
            for (Vec3& corner : face)
            {
                corner = place.local_to_world(corner);
                middle_ += corner / (3.0 * static_cast<double>(faces_.size()));
            }
        }
        for (const Triangle& face : faces_)
        {
            for (const Vec3& corner : face)
            {
                radius_m_ = std::max(radius_m_, (corner - middle_).norm());
            }
        }
    }

    [[nodiscard]] long double to(const Face& face) const
    {
        const Triangle triangle = to_triangle(face);
        if (holds(triangle[0]))
        {
            return 0;
        }
        long double least = DistanceOracle::kInfinity;
        for (const Triangle& own : faces_)
        {
            const std::span<const Vec3> corners(own.data(), is_segment_ ? 2U : 3U);
            least = std::min(least, ShapeOracle<long double>::distance(corners, triangle));
        }
        return least;
    }

    [[nodiscard]] long double to(const EditedSoup& soup) const
    {
        // The middle is a point of the core, so its distance is an upper bound.
        const double most_m = soup.oracle().tree().nearest(middle_).distance_m + 1e-9;
        long double least = DistanceOracle::kInfinity;
        for (const std::uint32_t face : near(soup, most_m))
        {
            least = std::min(least, to(soup.model().faces[face]));
        }
        return least;
    }

    /// Faces that may be within this distance of the core, in no order.
    [[nodiscard]] std::vector<std::uint32_t> near(const EditedSoup& soup, double distance_m) const
    {
        const Vec3 half = Vec3::Constant(radius_m_ + distance_m);
        std::vector<std::uint32_t> faces =
            soup.oracle().tree().faces_near_box(middle_ - half, middle_ + half);
        std::erase_if(faces,
                      [&](std::uint32_t face)
                      {
                          const auto apart_m = static_cast<double>(
                              brute_distance(middle_, soup.model().faces[face]));
                          return apart_m > radius_m_ + distance_m;
                      });
        return faces;
    }

private:
    /// True if the point is behind all faces of a solid, seen from its middle.
    [[nodiscard]] bool holds(const Vec3& point) const
    {
        return !is_segment_ &&
               std::ranges::all_of(
                   faces_,
                   [&](const Triangle& face)
                   {
                       const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
                       return normal.dot(point - face[0]) * normal.dot(middle_ - face[0]) >= 0.0;
                   });
    }

    std::vector<Triangle> faces_;
    bool is_segment_;
    Vec3 middle_{0.0, 0.0, 0.0};
    double radius_m_{0.0};
};

// --- Models --------------------------------------------------------------------------------------

/// Closed, open, flat, thin, smooth, bumpy, and loose surfaces with 500 to 20,000 faces.
constexpr std::size_t kEditedModels = 8;
const TestModel& edited_model(std::size_t index)
{
    switch (index)
    {
    case 0:
        return test_model("edits-sphere", make_shape(Shape::sphere, 2'000).value());
    case 1:
        return small_model(1); // Torus.
    case 2:
        return small_model(2); // Open sheet with bumps.
    case 3:
        return test_model("edits-plate", make_shape(Shape::plate, 2'000).value());
    case 4:
        return small_model(4); // Thin plate, flat, so that coarse faces are exact.
    case 5:
        return test_model("edits-least", make_uv_sphere(12, 24).value(), 100);
    case 6:
        return small_model(6); // Loose triangles.
    default:
        return test_model("edits-bumpy", make_shape(Shape::bumpy_sphere, 20'000).value());
    }
}

// --- Trials --------------------------------------------------------------------------------------

struct EditTrial
{
    const TestModel& model;
    Hardship hardship;
    TrialTool tool{TrialTool::sphere};
    double force_tolerance_n{0.0};
    std::uint64_t seed{0};
    std::uint32_t frames{0};
};

struct EditFigures
{
    TrialFigures truth; ///< Everything that a frame reports, against the soup.
    std::uint64_t edits{0};
    std::uint64_t refused{0};
    std::uint64_t exact{0};
    std::uint64_t tolerated{0};
    std::uint64_t contacts{0};
    std::uint64_t let_go{0};
    std::uint64_t merges{0};
    std::uint64_t hash{0}; ///< Hash of all reported distances, places and forces.

    void add(const EditFigures& other)
    {
        truth.add(other.truth);
        edits += other.edits;
        refused += other.refused;
        exact += other.exact;
        tolerated += other.tolerated;
        contacts += other.contacts;
        let_go += other.let_go;
        merges += other.merges;
    }
};

/// Frames of one trial with their edits and their evaluation.
class EditRun
{
public:
    explicit EditRun(const EditTrial& trial)
        : trial_(trial)
        , random_(Random::seeded(trial.seed))
        , solid_(solid_of(trial.tool))
        , room_(kRooms[random_.below(kRooms.size())])
        , spec_(spec_of())
        , soup_(trial.model, room_)
        , author_(soup_, random_)
        , hand_(trial.model, random_)
        , rig_(models_of(trial), options_of())
        , edits_each_(3 + random_.below(40U))
    {
        figures_.truth.name = trial.model.name + ", " + trial.hardship.name + ", " +
                              kTrialToolNames[static_cast<std::size_t>(trial.tool)];
        figures_.truth.unit = "of the bounds";
    }

    [[nodiscard]] EditFigures run()
    {
        for (; frame_ < trial_.frames && !is_lost_; ++frame_)
        {
            edit();
            step(next_goal(), trial_.hardship.budgets);
        }
        if (has_room_for_exactness() && !is_lost_)
        {
            settle();
        }
        return figures_;
    }

private:
    static constexpr std::array<std::uint32_t, 3> kRooms{40, 600, 4'000};

    static std::vector<const TestModel*> models_of(const EditTrial& trial)
    {
        std::vector<const TestModel*> models{&trial.model};
        if (trial.tool == TrialTool::mesh)
        {
            models.push_back(&mesh_of_tool());
        }
        return models;
    }

    [[nodiscard]] bool is_sphere() const { return trial_.tool <= TrialTool::measuring; }
    [[nodiscard]] bool is_mesh_tool() const { return trial_.tool == TrialTool::mesh; }

    [[nodiscard]] ToolSpec spec_of()
    {
        ToolSpec spec;
        spec.core = solid_.core;
        spec.radius_m =
            is_sphere() ? trial_.hardship.radius_diag * trial_.model.diagonal_m : solid_.radius_m;
        spec.wants_contacts = random_.one_in(2);
        spec.wants_pairs = is_mesh_tool();
        spec.query_only =
            trial_.tool == TrialTool::measuring || (!is_sphere() && random_.one_in(3));
        spec.wants_distance = trial_.tool == TrialTool::measuring;
        return spec;
    }

    [[nodiscard]] RigOptions options_of() const
    {
        RigOptions options = trial_.hardship.rig;
        options.tools = {spec_};
        options.edit_faces = room_;
        options.pool_bytes += std::size_t{room_} * 400;
        if (is_mesh_tool())
        {
            options.pool_bytes += std::size_t{2} << 20U;
        }
        options.faults.seed = trial_.seed + 1;
        options.force_tolerance_n = trial_.force_tolerance_n;
        return options;
    }

    /// Pools that hold what a tool's neighbourhood needs.
    [[nodiscard]] bool has_room_for_exactness() const
    {
        const std::string_view name = trial_.hardship.name;
        const bool is_scarce = name == "small-pools" || name == "few-pages" ||
                               name == "in-the-tool" ||
                               (name == "no-cache" && spec_.wants_distance);
        return trial_.force_tolerance_n == 0.0 && !is_scarce;
    }

    // --- Inputs ----------------------------------------------------------------------------------

    void edit()
    {
        came_.clear();
        is_edited_ = false;
        refused_.fill(0);
        if (frame_ < 5 || !random_.one_in(edits_each_))
        {
            return;
        }
        const std::uint32_t kind = random_.below(8U);
        if (kind < 2)
        {
            send_bad(static_cast<EditRefusal>(1 + random_.below(kEditRefusals - 1)));
        }
        send_valid();
        if (kind >= 5)
        {
            send_valid();
        }
        if (kind == 7)
        {
            send_bad(EditRefusal::too_many);
        }
    }

    void send_valid()
    {
        const OwnedEdit edit = author_.next(last_m_.value_or(Vec3(0.0, 0.0, 0.0)));
        rig_.edit(edit.view());
        soup_.apply(edit);
        for (const AddedFace& face : edit.added)
        {
            came_.push_back(face.corners_m);
        }
        is_edited_ = true;
        ++figures_.edits;
    }

    void send_bad(EditRefusal reason)
    {
        const auto edit = author_.bad(reason, last_m_.value_or(Vec3(0.0, 0.0, 0.0)));
        if (edit)
        {
            const bool is_unknown = reason == EditRefusal::unknown_model;
            rig_.edit(edit->view(ModelId{is_unknown ? 7U : 0U}));
            ++refused_[static_cast<std::size_t>(reason)];
            is_edited_ = true;
            ++figures_.refused;
        }
    }

    /// Starts outside the model, so that no rigid tool starts in a face.
    [[nodiscard]] Vec3 next_goal()
    {
        if (frame_ < kRestingFrames)
        {
            const FaceTree& tree = soup_.oracle().tree();
            return tree.high_m() + Vec3::Constant(0.3 * trial_.model.diagonal_m);
        }
        return hand_.next();
    }

    void step(const Vec3& goal_m, const Budgets& budgets)
    {
        ToolState state;
        state.position_m = goal_m;
        if (!is_sphere() && frame_ >= kRestingFrames)
        {
            const Eigen::AngleAxisd way(random_.between(-0.03, 0.03),
                                        (random_.in_cube(1.0) + Vec3(0, 0, 1e-3)).normalized());
            rotation_ = (Eigen::Quaterniond(way) * rotation_).normalized();
        }
        state.rotation = rotation_.toRotationMatrix();
        const FrameOutput output = rig_.step(std::span(&state, 1), budgets);
        judge(output, budgets);
    }

    // --- Evaluation ------------------------------------------------------------------------------

    void flag(const std::string& what)
    {
        figures_.truth.flag(figures_.truth.name + ", seed " + std::to_string(trial_.seed) +
                            ", frame " + std::to_string(frame_) + ": " + what);
    }

    void judge(const FrameOutput& output, const Budgets& budgets)
    {
        ++figures_.truth.trials;
        figures_.merges += output.work.merges;
        judge_edits(output);
        judge_tool(output);
        const PairOutput& pair = output.pairs[0];
        figures_.exact += pair.kind == AnswerKind::exact ? 1 : 0;
        figures_.tolerated += pair.kind == AnswerKind::within_tolerance ? 1 : 0;
        if (!is_edited_) // An edit's work is beside the budget.
        {
            if (const Verdict verdict = broken_budget(output, budgets))
            {
                flag(*verdict);
            }
        }
        // A point at rest has no reach, so it requests nothing.
        const bool reaches_nothing = spec_.radius_m == 0.0 && frame_ <= kRestingFrames;
        if (is_sphere() && trial_.force_tolerance_n == 0.0 && !reaches_nothing)
        {
            if (const Verdict verdict = unexplained(output))
            {
                flag(*verdict);
            }
        }
        judge_distance(pair);
        judge_faces(pair);
        mix(pair.lower_m);
        mix(pair.upper_m);
        for (Eigen::Index axis = 0; axis < 3; ++axis)
        {
            mix(output.tools[0].proxy_m[axis]);
            mix(output.tools[0].force_n[axis]);
        }
        last_m_ = output.tools[0].proxy_m;
        was_joined_ = pair.is_joined;
        kind_ = pair.kind;
        answer_ = "answer " + std::to_string(static_cast<int>(pair.kind)) + ", " +
                  exactly(pair.lower_m) + " .. " + exactly(pair.upper_m) + ", faults " +
                  std::to_string(static_cast<std::uint32_t>(output.faults)) + ", pages " +
                  std::to_string(output.models[0].pages.used) + " of " +
                  std::to_string(output.models[0].pages.capacity);
    }

    void mix(double value)
    {
        figures_.hash = mixed(figures_.hash, std::bit_cast<std::uint64_t>(value));
    }

    void judge_edits(const FrameOutput& output)
    {
        const ModelOutput& model = output.models[0];
        if (output.scene.edits_refused != refused_)
        {
            is_lost_ = true; // Everything later would follow from this.
            std::string text;
            for (std::size_t i = 0; i < kEditRefusals; ++i)
            {
                text += std::string(" ") + kEditRefusalNames[i] + " " +
                        std::to_string(output.scene.edits_refused[i]) + " of " +
                        std::to_string(refused_[i]);
            }
            flag("other edits are refused:" + text);
        }
        if (model.edit_revision != soup_.revision())
        {
            flag("revision " + std::to_string(model.edit_revision) + ", not " +
                 std::to_string(soup_.revision()));
        }
        if (model.added.used != soup_.added().size() || model.added.capacity != room_ ||
            model.added.used_max != soup_.added_max())
        {
            flag("added faces: " + std::to_string(model.added.used) + ", at most " +
                 std::to_string(model.added.used_max) + ", of " +
                 std::to_string(model.added.capacity) + ", not " +
                 std::to_string(soup_.added().size()) + ", " + std::to_string(soup_.added_max()) +
                 ", " + std::to_string(room_));
        }
    }

    /// Forces, passed faces, and letting go.
    void judge_tool(const FrameOutput& output)
    {
        const ToolOutput& tool = output.tools[0];
        const PairOutput& pair = output.pairs[0];
        if (!tool.force_n.allFinite() || !tool.torque_nm.allFinite() || !tool.proxy_m.allFinite() ||
            tool.force_n.norm() > spec_.force_max_n + kForceLimitRounding_n)
        {
            flag("force of " + exactly(tool.force_n) + " N");
        }
        if (!pair.is_joined && tool.force_n != Vec3(0.0, 0.0, 0.0))
        {
            flag("a force of an object that is not joined");
        }
        const bool is_joined = was_joined_ && pair.is_joined;
        if (was_joined_ && !pair.is_joined)
        {
            ++figures_.let_go;
            judge_letting_go();
        }
        if (is_sphere())
        {
            judge_path(is_joined && !spec_.query_only);
        }
        else if (is_joined && !spec_.query_only && (frame_ % 8 == 0 || !came_.empty()) &&
                 soup_.model().faces.size() > 0)
        {
            const int met =
                crossings(solid_, {tool.proxy_rotation, tool.proxy_m, 1.0}, soup_.model());
            if (met > 0 && !is_meeting_) // The first of several frames is enough.
            {
                flag("the tool meets " + std::to_string(met) + " faces: contact " +
                     std::to_string(tool.in_contact) + ", halted " + std::to_string(tool.halted) +
                     ", over-constrained " + std::to_string(tool.over_constrained) + ", force " +
                     exactly(tool.force_n.norm()) + " N, answer " +
                     std::to_string(static_cast<int>(pair.kind)));
            }
            is_meeting_ = met > 0;
        }
    }

    /// Only a face that came near the tool in this frame permits that it is let go.
    void judge_letting_go()
    {
        if (!last_m_)
        {
            return;
        }
        const bool is_near = std::ranges::any_of(
            came_,
            [this](const Face& face)
            {
                return !is_sphere() ||
                       static_cast<double>(brute_distance(*last_m_, face)) <= 2.0 * spec_.radius_m;
            });
        if (!is_near)
        {
            flag("let go without an added face at the tool");
        }
    }

    void judge_path(bool must_not_cross)
    {
        for (const Vec3& place_m : rig_.frame().tool(0).path_m())
        {
            if (must_not_cross && trail_m_ && *trail_m_ != place_m && !soup_.is_empty())
            {
                const auto crossing =
                    find_crossing(soup_.model(), soup_.oracle().tree(), *trail_m_, place_m);
                if (crossing)
                {
                    flag(crossing->text());
                }
            }
            trail_m_ = place_m;
        }
    }

    [[nodiscard]] double slack_m(const PairOutput& pair) const
    {
        return 1e-12 * trial_.model.diagonal_m + 1e-13 * pair.tool_m.norm();
    }

    void judge_distance(const PairOutput& pair)
    {
        if (soup_.is_empty())
        {
            if (pair.upper_m != kInfinity)
            {
                flag("a distance from nothing");
            }
            return;
        }
        if (is_sphere())
        {
            const BracketVerdict verdict = judge_bracket(soup_.oracle(), pair, ObjectPose{});
            if (!verdict.text.empty())
            {
                flag(verdict.text + ", answer " + std::to_string(static_cast<int>(pair.kind)));
            }
            judge_kind(
                pair,
                static_cast<double>(
                    soup_.oracle().nearest(wide_place(ObjectPose{}, pair.point_m)).distance_m));
        }
        else if (is_mesh_tool())
        {
            judge_mesh(pair);
        }
        else if (frame_ % 4 == 0 || is_edited_)
        {
            const PlacedSolid placed(solid_, {pair.tool_rotation, pair.tool_m, 1.0});
            judge_rigid(pair, static_cast<double>(placed.to(soup_)));
        }
    }

    void judge_rigid(const PairOutput& pair, double truth_m)
    {
        if (!(pair.lower_m <= truth_m + slack_m(pair) && truth_m <= pair.upper_m + slack_m(pair)))
        {
            flag("distance " + exactly(truth_m) + ", not " + exactly(pair.lower_m) + " .. " +
                 exactly(pair.upper_m) + ", answer " + std::to_string(static_cast<int>(pair.kind)));
        }
        judge_kind(pair, truth_m);
    }

    void judge_kind(const PairOutput& pair, double truth_m)
    {
        // With a tolerance, faces within 2^-20 quanta count as equally near.
        const double tied_m = trial_.force_tolerance_n > 0.0
                                  ? 0x1p-20 * static_cast<double>(soup_.source().quantum_m)
                                  : 0.0;
        if (pair.kind == AnswerKind::exact &&
            !(pair.upper_m - pair.lower_m <= slack_m(pair) + tied_m))
        {
            flag("an exact answer from " + exactly(pair.lower_m) + " to " + exactly(pair.upper_m));
        }
        if (pair.kind == AnswerKind::within_tolerance &&
            !(trial_.force_tolerance_n > 0.0 &&
              pair.lower_m >= truth_m - 2.0 * pair.tolerated_m - slack_m(pair)))
        {
            flag("within a tolerance of " + exactly(pair.tolerated_m) + ", but " +
                 exactly(pair.lower_m) + " for " + exactly(truth_m));
        }
    }

    void judge_mesh(const PairOutput& pair)
    {
        if (frame_ % 8 != 0 && !is_edited_)
        {
            return;
        }
        const FinestMesh& tool_mesh = finest_mesh(mesh_of_tool());
        TestModel tool = mesh_of_tool();
        tool.faces.clear();
        for (const SourceFace& face : tool_mesh.faces)
        {
            tool.faces.push_back(face.corners);
        }
        MeshPairOracle oracle(tool, soup_.model());
        ToolState at;
        at.position_m = pair.tool_m;
        at.rotation = pair.tool_rotation;
        oracle.place(ObjectPose{}, at);
        const std::vector<FacePair> meeting = oracle.meeting();
        judge_rigid(pair, meeting.empty() ? static_cast<double>(oracle.nearest().distance_m) : 0.0);
        if (pair.mesh == nullptr)
        {
            flag("there is no report of a mesh");
            return;
        }
        const MeshReport& report = *pair.mesh;
        if ((report.intersection == Intersection::none && !meeting.empty()) ||
            (report.intersection == Intersection::proven && meeting.empty()))
        {
            flag(std::to_string(meeting.size()) + " pairs meet, but it says " +
                 kIntersectionNames[static_cast<std::size_t>(report.intersection)]);
        }
        for (const MeetingFaces& faces : report.meeting)
        {
            const auto own =
                std::ranges::lower_bound(tool_mesh.faces, faces.tool_face.value, {},
                                         [](const SourceFace& face) { return face.id.value; });
            const auto place = soup_.place_of(faces.face);
            if (own == tool_mesh.faces.end() || own->id != faces.tool_face || !place ||
                !oracle.do_meet(
                    {static_cast<std::uint32_t>(own - tool_mesh.faces.begin()), *place}))
            {
                flag("said to meet, but do not: faces " + std::to_string(faces.tool_face.value) +
                     " and " + std::to_string(faces.face.value));
            }
        }
        if (report.is_complete && report.meeting.size() != meeting.size())
        {
            flag(std::to_string(report.meeting.size()) + " pairs are said to be all of " +
                 std::to_string(meeting.size()));
        }
    }

    /// Named faces of exact surfaces are part of the edited surface and are where they are said to
    /// be.
    void judge_faces(const PairOutput& pair)
    {
        if (trial_.force_tolerance_n > 0.0 || is_mesh_tool())
        {
            return;
        }
        const PlacedSolid placed(solid_, {pair.tool_rotation, pair.tool_m, 1.0});
        const auto distance_m = [&](std::uint32_t face)
        {
            const Face& corners = soup_.model().faces[face];
            return static_cast<double>(is_sphere() ? brute_distance(pair.point_m, corners)
                                                   : placed.to(corners));
        };
        if (pair.kind == AnswerKind::exact)
        {
            const auto place = soup_.place_of(pair.nearest_face);
            if (!place)
            {
                flag("nearest is face " + std::to_string(pair.nearest_face.value) +
                     ", which is not part of the surface");
            }
            else if (const double found_m = distance_m(*place);
                     !(std::abs(found_m - pair.lower_m) <= 10.0 * slack_m(pair)))
            {
                flag("the nearest face is " + exactly(found_m) + " away, not " +
                     exactly(pair.lower_m));
            }
        }
        if (pair.contacts == nullptr)
        {
            return;
        }
        for (const Contact& contact : pair.contacts->contacts)
        {
            ++figures_.contacts;
            const auto place = soup_.place_of(contact.face);
            if (!place)
            {
                flag("a contact with face " + std::to_string(contact.face.value) +
                     ", which is not part of the surface");
            }
            else if (const double found_m = distance_m(*place);
                     !(std::abs(found_m - contact.distance_m) <= 10.0 * slack_m(pair)))
            {
                flag("a contact is " + exactly(found_m) + " away, not " +
                     exactly(contact.distance_m));
            }
        }
        if (pair.contacts->is_complete && (frame_ % 8 == 0 || is_edited_) && !soup_.is_empty())
        {
            judge_complete(pair, placed);
        }
    }

    void judge_complete(const PairOutput& pair, const PlacedSolid& placed)
    {
        const double within_m = spec_.radius_m - 10.0 * slack_m(pair);
        std::vector<std::uint32_t> near;
        if (is_sphere())
        {
            const Vec3 half = Vec3::Constant(spec_.radius_m);
            near = soup_.oracle().tree().faces_near_box(pair.tool_m - half, pair.tool_m + half);
        }
        else
        {
            near = placed.near(soup_, spec_.radius_m);
        }
        const auto touching = std::ranges::count_if(
            near,
            [&](std::uint32_t face)
            {
                const Face& corners = soup_.model().faces[face];
                const long double found_m =
                    is_sphere() ? brute_distance(pair.tool_m, corners) : placed.to(corners);
                return static_cast<double>(found_m) <= within_m;
            });
        if (touching > static_cast<std::ptrdiff_t>(pair.contacts->contacts.size()))
        {
            flag(std::to_string(pair.contacts->contacts.size()) +
                 " contacts are said to be all of " + std::to_string(touching));
        }
    }

    /// Everything arrives, and the answer becomes exact while the tool rests.
    void settle()
    {
        came_.clear();
        is_edited_ = false;
        refused_.fill(0);
        const Vec3 place_m = last_m_.value_or(Vec3(0.0, 0.0, 0.0));
        const auto is_done = [this] {
            return kind_ == AnswerKind::exact ||
                   (kind_ == AnswerKind::separated && !spec_.wants_distance);
        };
        kind_ = AnswerKind::bounded;
        const std::uint32_t first = frame_;
        while (!is_done() && frame_ < first + kSettledFrames)
        {
            step(place_m, Budgets{});
            ++frame_;
        }
        if (!is_done())
        {
            flag("no exact answer though all budgets are ample: " + answer_);
        }
    }

    const EditTrial& trial_;
    Random random_;
    SolidCore solid_;
    std::uint32_t room_;
    ToolSpec spec_;
    EditedSoup soup_;
    EditAuthor author_;
    WanderingOperator hand_;
    FrameRig rig_;
    std::uint32_t edits_each_; ///< Mean number of frames between edits.
    std::uint32_t frame_{0};
    Eigen::Quaterniond rotation_{Eigen::Quaterniond::Identity()};
    std::vector<Face> came_; ///< Faces that the present frame adds.
    bool is_edited_{false};  ///< The present frame was sent edits, valid or not.
    std::array<std::uint32_t, kEditRefusals> refused_{};
    std::optional<Vec3> last_m_;  ///< Proxy after the last frame.
    std::optional<Vec3> trail_m_; ///< Last place of the proxy's path.
    bool was_joined_{false};
    bool is_meeting_{false}; ///< The tool met a face when that was last checked.
    bool is_lost_{false};    ///< The frame's surface is not the soup's.
    std::string answer_;     ///< The last frame's answer, for messages.
    AnswerKind kind_{AnswerKind::bounded};
    EditFigures figures_;
};

EditFigures run_edit_trial(const EditTrial& trial)
{
    return EditRun(trial).run();
}

std::string name_of_hardship(const testing::TestParamInfo<const char*>& one)
{
    std::string name = one.param;
    std::ranges::replace(name, '-', '_');
    return name;
}

class Edits : public testing::TestWithParam<const char*>
{
protected:
    /// Sets a longer interval for larger models.
    void SetUp() override { FrameRig::validate_every(10); }
    void TearDown() override { FrameRig::validate_every(TACTUS_VALIDATED_EVERY); }

    static void expect_true(const EditFigures& figures)
    {
        std::printf("[ figures  ] %llu frames, %llu edits, %llu refused, %llu exact, %llu "
                    "tolerated, %llu contacts, %llu let go, %llu merges\n",
                    static_cast<unsigned long long>(figures.truth.trials),
                    static_cast<unsigned long long>(figures.edits),
                    static_cast<unsigned long long>(figures.refused),
                    static_cast<unsigned long long>(figures.exact),
                    static_cast<unsigned long long>(figures.tolerated),
                    static_cast<unsigned long long>(figures.contacts),
                    static_cast<unsigned long long>(figures.let_go),
                    static_cast<unsigned long long>(figures.merges));
        EXPECT_TRUE(figures.truth.holds()) << figures.truth.summary();
    }

    /// Trials of every model with these tools.
    static EditFigures run_all(std::initializer_list<TrialTool> tools, std::uint64_t first_seed,
                               double tolerance_n, std::uint32_t frames)
    {
        EditFigures all;
        for (std::size_t i = 0; i < kEditedModels; ++i)
        {
            const TestModel& model = edited_model(i);
            for (const TrialTool tool : tools)
            {
                const std::uint64_t seed =
                    seed_of(first_seed) + tools.size() * i + static_cast<std::uint64_t>(tool);
                all.add(run_edit_trial({model, hardship_named(model, GetParam()), tool, tolerance_n,
                                        seed, trial_length(frames)}));
            }
        }
        expect_true(all);
        return all;
    }
};

TEST_P(Edits, are_answered_truly_for_spheres_under_this_hardship)
{
    const EditFigures all = run_all({TrialTool::sphere, TrialTool::measuring}, 6'100, 0.0, 1'000);
    EXPECT_GT(all.edits, kEditedModels * trial_length(1'000) / 25);
    EXPECT_GT(all.refused, 10U);
    if (std::string_view(GetParam()) != "static" && std::string_view(GetParam()) != "in-the-tool")
    {
        EXPECT_GT(all.merges, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Hardships, Edits,
                         testing::Values("usual", "point", "K-1", "K-4", "starved", "small-pools",
                                         "few-pages", "no-cache", "lossy-link", "late-link",
                                         "in-the-tool", "static", "little-work"),
                         name_of_hardship);

using EditsOfRigidTools = Edits;

TEST_P(EditsOfRigidTools, are_answered_truly_for_every_core)
{
    const EditFigures all = run_all(
        {TrialTool::capsule, TrialTool::box, TrialTool::hull, TrialTool::mesh}, 6'200, 0.0, 600);
    EXPECT_GT(all.edits, 100U);
}

INSTANTIATE_TEST_SUITE_P(Hardships, EditsOfRigidTools,
                         testing::Values("usual", "K-4", "late-link", "static"), name_of_hardship);

using EditsWithinATolerance = Edits;

/// Coarse faces count as the surface only where no edit touched what they stand for.
TEST_P(EditsWithinATolerance, are_answered_within_it)
{
    const EditFigures all =
        run_all({TrialTool::sphere, TrialTool::box, TrialTool::mesh}, 6'300, 0.001, 800);
    EXPECT_GT(all.tolerated, 0U);
}

INSTANTIATE_TEST_SUITE_P(Hardships, EditsWithinATolerance,
                         testing::Values("usual", "small-pools", "few-pages"), name_of_hardship);

/// Edits may change all coarse faces near a tool that measures, so that nothing bounds the distance
/// from above; found with seed 104 of long runs.
TEST(EditsFound, a_distance_without_an_upper_bound_is_still_found)
{
    const TestModel& model = edited_model(6); // Loose triangles.
    const EditFigures figures = run_edit_trial(
        {model, hardship_named(model, "lossy-link"), TrialTool::measuring, 0.0, 117, 1'000});
    EXPECT_TRUE(figures.truth.holds()) << figures.truth.summary();
}

TEST(EditsAgain, give_the_same_bits)
{
    for (const char* name : {"usual", "lossy-link", "small-pools"})
    {
        const TestModel& model = edited_model(1);
        const EditTrial trial{
            model, hardship_named(model, name), TrialTool::sphere, 0.0, seed_of(6'400), 200};
        const std::uint64_t first = run_edit_trial(trial).hash;
        EXPECT_EQ(run_edit_trial(trial).hash, first) << name;
        EditTrial other = {model, trial.hardship, trial.tool, 0.0, trial.seed + 1, 200};
        EXPECT_NE(run_edit_trial(other).hash, first) << name;
    }
}

} // namespace
} // namespace tactus::test
