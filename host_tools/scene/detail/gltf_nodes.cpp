// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_nodes.hpp"

#include "host_tools/scene/detail/gltf_accessor.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/printable.hpp"
#include "transport/material_text.hpp"
#include "transport/model_name.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::detail
{

namespace
{

/// Tolerance of an object's axes against equal length and right angles, as a share of their length:
/// files have single precision, and rounding accumulates along a chain of parents.
constexpr double kShapeTolerance = 1e-5;

/// Tolerance of the length of an instance's quaternion, which may consist of normalized 8-bit
/// integers.
constexpr double kInstanceUnitTolerance = 0.02;

constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();
constexpr std::string_view kModelExtension = ".spm";
/// Remedies for a node that cannot be touched as it is.
constexpr std::string_view kLeaveOut = "or exclude it by extras.tactus.touch = false";
constexpr std::string_view kKeep = "extras.tactus.touch = true keeps it";

/// Affine map p -> linear x p + translation, from a node's frame to its parent's or to the world.
struct Affine
{
    Mat3 linear{Mat3::Identity()};
    Vec3 translation{0.0, 0.0, 0.0};

    [[nodiscard]] Affine after(const Affine& inner) const
    {
        return {linear * inner.linear, linear * inner.translation + translation};
    }
};

template <std::size_t N>
std::array<double, N> numbers(const JsonAt& json)
{
    if (json.size() != N)
    {
        json.refuse(fmt::format("has {} numbers; {} are needed", json.size(), N));
    }
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i)
    {
        values[i] = json.at(i).number();
    }
    return values;
}

/// Matrix in column order, as in the standard.
Affine read_matrix(const JsonAt& json)
{
    const auto m = numbers<16>(json);
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
    {
        json.refuse("must have the last row 0 0 0 1");
    }
    Affine affine;
    for (Eigen::Index column = 0; column < 3; ++column)
    {
        for (Eigen::Index row = 0; row < 3; ++row)
        {
            affine.linear(row, column) = m[static_cast<std::size_t>(4 * column + row)];
        }
    }
    affine.translation = Vec3(m[12], m[13], m[14]);
    return affine;
}

/// Rotation of a quaternion, whose length must be 1 within `tolerance`; `json` is named in
/// refusals.
Mat3 rotation_of(const std::array<double, 4>& quaternion, const JsonAt& json, double tolerance)
{
    const auto [x, y, z, w] = quaternion;
    const Eigen::Quaterniond rotation(w, x, y, z);
    if (!(std::abs(rotation.norm() - 1.0) <= tolerance))
    {
        json.refuse(fmt::format("has the length {}; a unit quaternion has 1", rotation.norm()));
    }
    return rotation.normalized().toRotationMatrix();
}

Affine read_transform(const JsonAt& node)
{
    const auto matrix = node.find("matrix");
    const auto translation = node.find("translation");
    const auto rotation = node.find("rotation");
    const auto scale = node.find("scale");
    if (matrix)
    {
        if (translation || rotation || scale)
        {
            node.refuse("has both a matrix and translation, rotation or scale");
        }
        return read_matrix(*matrix);
    }
    Affine affine;
    if (rotation)
    {
        affine.linear = rotation_of(numbers<4>(*rotation), *rotation, kPoseUnitTolerance);
    }
    if (scale)
    {
        const auto s = numbers<3>(*scale);
        affine.linear *= Vec3(s[0], s[1], s[2]).asDiagonal();
    }
    if (translation)
    {
        const auto t = numbers<3>(*translation);
        affine.translation = Vec3(t[0], t[1], t[2]);
    }
    return affine;
}

/// Parents of all nodes, and an order of the nodes in which parents come first.
class NodeTree
{
public:
    explicit NodeTree(const GltfFile& file) : parents_(count_nodes(file), kNoParent)
    {
        const std::size_t count = parents_.size();
        for (std::size_t i = 0; i < count; ++i)
        {
            adopt_children(file, i);
        }
        for (std::size_t i = 0; i < count; ++i)
        {
            if (parents_[i] == kNoParent)
            {
                order_.push_back(i);
            }
        }
        for (std::size_t next = 0; next < order_.size(); ++next)
        {
            const std::vector<std::size_t>& children = children_[order_[next]];
            order_.insert(order_.end(), children.begin(), children.end());
        }
        if (order_.size() < count)
        {
            refuse_cycle(file);
        }
    }

    [[nodiscard]] const std::vector<std::size_t>& order() const noexcept { return order_; }
    [[nodiscard]] std::size_t parent(std::size_t node) const { return parents_[node]; }

private:
    static std::size_t count_nodes(const GltfFile& file)
    {
        const std::size_t count = file.root().size_of("nodes");
        if (count > kMaxNodes)
        {
            throw SceneFault{fmt::format("has {} nodes; at most {}", count, kMaxNodes)};
        }
        return count;
    }

    void adopt_children(const GltfFile& file, std::size_t node)
    {
        const auto list = file.root().at("nodes").at(node).find("children");
        children_.resize(parents_.size());
        for (std::size_t i = 0; list && i < list->size(); ++i)
        {
            const std::size_t child = list->at(i).index_below(parents_.size(), "nodes");
            if (parents_[child] != kNoParent)
            {
                throw SceneFault{fmt::format("{} has two parents, nodes[{}] and nodes[{}]",
                                             file.described("nodes", child), parents_[child],
                                             node)};
            }
            parents_[child] = node;
            children_[node].push_back(child);
        }
    }

    /// Refuses nodes in a cycle, which no root reaches.
    [[noreturn]] void refuse_cycle(const GltfFile& file) const
    {
        std::vector<bool> is_reached(parents_.size(), false);
        for (const std::size_t node : order_)
        {
            is_reached[node] = true;
        }
        const auto lost =
            static_cast<std::size_t>(std::ranges::find(is_reached, false) - is_reached.begin());
        // The first lost node may be below the cycle; its ancestor after this number of steps is in
        // the cycle.
        std::size_t node = lost;
        for (std::size_t i = 0; i < parents_.size(); ++i)
        {
            node = parents_[node];
        }
        throw SceneFault{file.described("nodes", node) + " is its own ancestor"};
    }

    std::vector<std::size_t> parents_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> order_;
};

/// Flags by node: true if the file's scene shows it, that is, for its roots and all nodes below.
std::vector<bool> find_shown(const GltfFile& file, const NodeTree& tree)
{
    const JsonAt root = file.root();
    const std::size_t scenes = root.size_of("scenes");
    if (scenes == 0)
    {
        throw SceneFault{"has no scene"};
    }
    const auto chosen = root.find("scene");
    const JsonAt scene = root.at("scenes").at(chosen ? chosen->index_below(scenes, "scenes") : 0);
    std::vector<bool> is_shown(tree.order().size(), false);
    const auto list = scene.find("nodes");
    for (std::size_t i = 0; list && i < list->size(); ++i)
    {
        const std::size_t node = list->at(i).index_below(is_shown.size(), "nodes");
        if (tree.parent(node) != kNoParent)
        {
            list->at(i).refuse(fmt::format("is {}, which is a child of nodes[{}], not a root",
                                           file.described("nodes", node), tree.parent(node)));
        }
        is_shown[node] = true;
    }
    for (const std::size_t node : tree.order())
    {
        const std::size_t parent = tree.parent(node);
        is_shown[node] = is_shown[node] || (parent != kNoParent && is_shown[parent]);
    }
    return is_shown;
}

/// Reason why each node is invisible; empty for a visible node.
class HiddenNodes
{
public:
    HiddenNodes(const GltfFile& file, const NodeTree& tree) : reasons_(tree.order().size())
    {
        for (const std::size_t node : tree.order())
        {
            read(file.root().at("nodes").at(node), node);
        }
        for (const std::size_t node : tree.order())
        {
            const std::size_t parent = tree.parent(node);
            if (parent != kNoParent && reasons_[node].empty())
            {
                reasons_[node] = reasons_[parent];
            }
        }
    }

    [[nodiscard]] std::string_view reason(std::size_t node) const { return reasons_[node]; }

private:
    void read(const JsonAt& node, std::size_t number)
    {
        const auto extensions = node.find("extensions");
        const auto visibility = extensions ? extensions->find("KHR_node_visibility") : std::nullopt;
        const auto visible = visibility ? visibility->find("visible") : std::nullopt;
        if (visible && !visible->boolean())
        {
            reasons_[number] = "hidden by KHR_node_visibility";
        }
        const auto levels = extensions ? extensions->find("MSFT_lod") : std::nullopt;
        const auto ids = levels ? levels->find("ids") : std::nullopt;
        for (std::size_t i = 0; ids && i < ids->size(); ++i)
        {
            const std::size_t lower = ids->at(i).index_below(reasons_.size(), "nodes");
            if (lower != number)
            {
                reasons_[lower] = "a lower level of detail by MSFT_lod";
            }
        }
    }

    std::vector<std::string_view> reasons_; ///< Reason by node; empty for a visible node.
};

Material read_material(const JsonAt& json)
{
    json.require_keys_among(
        "stiffness static dynamic damping viscosity texture_height texture_length");
    const Material material = material_of(
        [&json](std::string_view key)
        {
            const auto value = json.find(std::string(key).c_str());
            return value ? std::optional(value->number()) : std::nullopt;
        });
    if (!is_in_range(material))
    {
        json.refuse(fmt::format("must have {}", kMaterialRanges));
    }
    return material;
}

/// File name "x.spm" of a model that can be published as "x".
std::string read_model(const JsonAt& json)
{
    const std::string& name = json.text();
    if (!name.ends_with(kModelExtension) ||
        !is_valid_name(std::string_view(name).substr(0, name.size() - kModelExtension.size())))
    {
        json.refuse(fmt::format(
            "is '{}'; must be an .spm file in the scene file's folder with a name of {}",
            printable(name), kNameForm));
    }
    return name;
}

/// Reads `extras`, which may hold other programs' data; "tactus" is ours. Returns true if it
/// requests that the object be touched.
bool read_extras(const JsonAt& node, SceneObject& object)
{
    const auto extras = node.find("extras");
    const auto ours = extras && extras->json().is_object() ? extras->find("tactus") : std::nullopt;
    if (!ours)
    {
        return false;
    }
    ours->require_keys_among("model material touch");
    if (const auto model = ours->find("model"))
    {
        object.model = read_model(*model);
    }
    if (const auto material = ours->find("material"))
    {
        object.material = read_material(*material);
    }
    const auto touch = ours->find("touch");
    object.is_touched = !touch || touch->boolean();
    return touch && object.is_touched;
}

/// Scale, moved to the nearest end of the allowed range if it is outside by rounding only.
double rounded_into_range(double scale)
{
    const double nearest = std::clamp(scale, kPoseScaleMin, kPoseScaleMax);
    return std::abs(scale - nearest) <= kShapeTolerance * nearest ? nearest : scale;
}

/// True if the map reduces everything to a point or a line.
bool leaves_no_surface(const Mat3& linear)
{
    const Vec3 axes = linear.jacobiSvd().singularValues(); // Singular values, the largest first.
    return axes[1] <= kShapeTolerance * kShapeTolerance * axes[0];
}

/// Sets the pose from the node's map to the world, which must be a similarity, mirrored or not.
void set_pose(const Affine& world, SceneObject& object)
{
    const auto refuse = [&](const std::string& what, std::string_view way)
    { throw SceneFault{fmt::format("{} {}: {}, {}", object.place, what, way, kLeaveOut)}; };
    constexpr std::string_view kApply = "apply its scale to the mesh in the modeller (in Blender "
                                        "Object > Apply > Scale)";
    Mat3 axes = world.linear;
    const bool is_mirrored = axes.determinant() < 0.0;
    if (is_mirrored)
    {
        axes.col(0) = -axes.col(0);
    }
    const Vec3 lengths = axes.colwise().norm().transpose();
    const double scale = lengths.mean();
    if (!(lengths.minCoeff() > 0.0))
    {
        refuse("has a scale of 0 along an axis; a model is rigid", kApply);
    }
    if (lengths.maxCoeff() - lengths.minCoeff() > 2.0 * kShapeTolerance * scale)
    {
        refuse(fmt::format("scales its axes by {:.6g}, {:.6g} and {:.6g}; a model is rigid, so the "
                           "scales must be equal",
                           lengths.x(), lengths.y(), lengths.z()),
               kApply);
    }
    const Mat3 rotation = axes / scale;
    const Mat3 product = rotation.transpose() * rotation;
    if ((product - Mat3::Identity()).cwiseAbs().maxCoeff() > 4.0 * kShapeTolerance)
    {
        refuse("has axes that are not perpendicular; a model is rigid",
               "apply its transform, and those of its parents, to the mesh in the modeller");
    }
    const Eigen::Quaterniond turn = Eigen::Quaterniond(rotation).normalized();
    object.pose.rotation = {turn.x(), turn.y(), turn.z(), turn.w()};
    std::copy_n(world.translation.data(), 3, object.pose.translation_m.begin());
    object.pose.scale = rounded_into_range(scale);
    if (const auto checked = checked_pose(object.pose); !checked)
    {
        if (checked.error() == PoseRefusal::translation)
        {
            refuse(fmt::format("lies farther than {} m from the origin along an axis",
                               kPoseReachMax_m),
                   "move the scene to its origin in the modeller");
        }
        refuse(fmt::format("has a scale of {:.6g}; {} to {} is allowed", scale, kPoseScaleMin,
                           kPoseScaleMax),
               kApply);
    }
    if (is_mirrored && !object.model.empty())
    {
        refuse("mirrors its model, which is not supported",
               "mirror the mesh and build a model from the mirrored mesh");
    }
    if (object.mesh)
    {
        object.mesh->is_mirrored = is_mirrored;
    }
}

/// A node that is one object, or one object for each of its instances.
struct ObjectNode
{
    std::size_t node{0};
    SceneObject object; ///< Object; its pose is not set.
};

/// Object of a node; none if the node is no object or is ignored.
std::optional<ObjectNode> read_object(const GltfFile& file, std::size_t index,
                                      std::string_view hidden, LeftOut& left_out)
{
    const JsonAt node = file.root().at("nodes").at(index);
    SceneObject object;
    object.place = file.described("nodes", index);
    const bool is_kept = read_extras(node, object);
    if (const auto mesh = node.find("mesh"))
    {
        object.mesh = MeshUse{mesh->index_below(file.root().size_of("meshes"), "meshes")};
    }
    if (!object.mesh && object.model.empty())
    {
        return std::nullopt;
    }
    if (!hidden.empty() && object.is_touched && !is_kept)
    {
        left_out.add(fmt::format("{}; {}", hidden, kKeep), object.place);
        return std::nullopt;
    }
    if (node.find("skin") && object.is_touched && object.model.empty())
    {
        throw SceneFault{fmt::format(
            "{} has a skin; a model is rigid: apply the armature to the mesh in the modeller, {}",
            object.place, kLeaveOut)};
    }
    const std::string name = plain_name(node.name());
    object.name = name.empty() ? "node" + std::to_string(index) : name;
    if (!object.model.empty())
    {
        object.mesh.reset(); // The mesh is then only for display.
    }
    return ObjectNode{index, std::move(object)};
}

/// Maps from each instance's frame to the node's (EXT_mesh_gpu_instancing); none if the node has no
/// instances.
std::optional<std::vector<Affine>> read_instances(GltfFile& file, std::size_t index)
{
    const JsonAt node = file.root().at("nodes").at(index);
    const auto extensions = node.find("extensions");
    const auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
    const auto attributes = instancing ? instancing->find("attributes") : std::nullopt;
    if (!attributes)
    {
        return std::nullopt;
    }
    std::size_t count = 0;
    const auto accessor = [&](const char* name, std::size_t width) -> std::optional<GltfAccessor>
    {
        const auto number = attributes->find(name);
        if (!number)
        {
            return std::nullopt;
        }
        GltfAccessor values(file,
                            number->index_below(file.root().size_of("accessors"), "accessors"));
        values.require_width(width);
        if (count != 0 && values.count() != count)
        {
            number->refuse(
                fmt::format("has {} instances; another attribute has {}", values.count(), count));
        }
        count = values.count();
        return values;
    };
    const auto translations = accessor("TRANSLATION", 3);
    const auto rotations = accessor("ROTATION", 4);
    const auto scales = accessor("SCALE", 3);
    if (count > kMaxObjects)
    {
        attributes->refuse(
            fmt::format("have {} instances; at most {} objects are allowed", count, kMaxObjects));
    }
    if (count == 0)
    {
        return std::nullopt; // The extension lists no instances.
    }
    std::vector<Affine> instances(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        Affine& instance = instances[i];
        if (rotations)
        {
            instance.linear =
                rotation_of(rotations->numbers<4>(i), *attributes, kInstanceUnitTolerance);
        }
        if (scales)
        {
            instance.linear *= Vec3(scales->numbers<3>(i).data()).asDiagonal();
        }
        if (translations)
        {
            instance.translation = Vec3(translations->numbers<3>(i).data());
        }
    }
    return instances;
}

/// Maps to the world, by node; set for the marked nodes and their ancestors only.
std::vector<Affine> place_nodes(const GltfFile& file, const NodeTree& tree,
                                std::vector<bool> is_needed)
{
    const std::vector<std::size_t>& order = tree.order();
    for (auto node = order.rbegin(); node != order.rend(); ++node)
    {
        if (is_needed[*node] && tree.parent(*node) != kNoParent)
        {
            is_needed[tree.parent(*node)] = true;
        }
    }
    std::vector<Affine> worlds(order.size());
    for (const std::size_t node : order)
    {
        if (is_needed[node])
        {
            const Affine local = read_transform(file.root().at("nodes").at(node));
            const std::size_t parent = tree.parent(node);
            worlds[node] = parent == kNoParent ? local : worlds[parent].after(local);
        }
    }
    return worlds;
}

/// Collects objects in order; checks their number and poses, and makes their names unique.
class ObjectList
{
public:
    explicit ObjectList(LeftOut& left_out) : left_out_(&left_out) {}

    void add(SceneObject object, const Affine& world)
    {
        if (objects_.size() == kMaxObjects)
        {
            throw SceneFault{fmt::format("has more than {} objects; join some in the modeller, or "
                                         "exclude some by extras.tactus.touch = false",
                                         kMaxObjects)};
        }
        if (object.is_touched && (!world.linear.allFinite() || !world.translation.allFinite()))
        {
            throw SceneFault{object.place +
                             " has no finite pose in the world, with its parents' transforms"};
        }
        if (object.is_touched && leaves_no_surface(world.linear))
        {
            left_out_->add("scaled to a point or a line", object.place);
            return;
        }
        if (object.is_touched)
        {
            set_pose(world, object);
        }
        names_.push_back(object.name);
        objects_.push_back(std::move(object));
    }

    [[nodiscard]] std::vector<SceneObject> take()
    {
        names_ = unique_names(names_);
        for (std::size_t i = 0; i < objects_.size(); ++i)
        {
            objects_[i].name = std::move(names_[i]);
        }
        return std::move(objects_);
    }

private:
    LeftOut* left_out_;
    std::vector<SceneObject> objects_;
    std::vector<std::string> names_;
};

} // namespace

std::vector<SceneObject> read_objects(GltfFile& file, LeftOut& left_out)
{
    const NodeTree tree(file);
    const std::vector<bool> is_shown = find_shown(file, tree);
    const HiddenNodes hidden(file, tree);
    std::vector<ObjectNode> nodes;
    std::vector<bool> is_placed(is_shown.size(), false);
    for (std::size_t node = 0; node < is_shown.size(); ++node)
    {
        auto object =
            is_shown[node] ? read_object(file, node, hidden.reason(node), left_out) : std::nullopt;
        if (object)
        {
            is_placed[node] = object->object.is_touched;
            nodes.push_back(std::move(*object));
        }
    }
    const std::vector<Affine> worlds = place_nodes(file, tree, is_placed);
    ObjectList objects(left_out);
    for (const ObjectNode& node : nodes)
    {
        const auto instances =
            node.object.is_touched ? read_instances(file, node.node) : std::nullopt;
        for (std::size_t i = 0; instances && i < instances->size(); ++i)
        {
            SceneObject object = node.object;
            object.place += fmt::format(" instance {}", i);
            objects.add(std::move(object), worlds[node.node].after((*instances)[i]));
        }
        if (!instances)
        {
            objects.add(node.object, worlds[node.node]);
        }
    }
    return objects.take();
}

} // namespace tactus::detail
