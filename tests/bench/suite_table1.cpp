// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `table1`: the models of Table 1 of the 3DIM 2005 paper, encoded by us, and the height of
/// the fully refined AB-Tree over each.

#include "host_tools/shapes/shapes.hpp"
#include "rt_core/spm/ids.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::bench
{
namespace
{

/// The 3DIM 2005 paper's AB-Tree: a binary tree over all faces of the finest mesh, one face a leaf,
/// in which every node is inactive, active or deformed. When a face becomes active, its leaf and
/// all nodes above it are deformed until refit(). Shares only the order of the faces with the
/// 8-wide tree. No boxes.
class BinaryAbTree
{
public:
    enum class Status : std::uint8_t
    {
        inactive,
        active,
        deformed,
    };
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    /// Builds from the faces of the finest mesh in the order of their paths, each range halved in
    /// the middle, so that all leaves are on the two lowest levels.
    explicit BinaryAbTree(std::span<const FaceId> faces)
    {
        nodes_.reserve(2 * faces.size());
        build(faces, kNone);
    }

    void set(FaceId face)
    {
        for (std::uint32_t node = leaf_of(face); node != kNone; node = nodes_[node].parent)
        {
            nodes_[node].status = Status::deformed;
        }
    }
    void refit()
    {
        for (Node& node : nodes_)
        {
            node.status = node.status == Status::deformed ? Status::active : node.status;
        }
    }

    [[nodiscard]] Status status(std::uint32_t node) const { return nodes_[node].status; }
    [[nodiscard]] std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }
    /// Leaf of a face, from the index list.
    [[nodiscard]] std::uint32_t leaf_of(FaceId face) const { return leaf_of_[face.value]; }

private:
    struct Node
    {
        std::uint32_t parent{kNone};
        Status status{Status::inactive};
    };

    void build(std::span<const FaceId> faces, std::uint32_t parent)
    {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({parent});
        if (faces.size() > 1)
        {
            build(faces.first(faces.size() / 2), index);
            build(faces.subspan(faces.size() / 2), index);
            return;
        }
        leaf_of_.resize(std::max(leaf_of_.size(), std::size_t{faces[0].value} + 1), kNone);
        leaf_of_[faces[0].value] = index;
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;
};

constexpr SceneSource kCow{"cow", "cow.obj", 0, 5'804};
constexpr std::uint32_t kSmallBunnyFaces = 37'576;

struct Table1Case
{
    const char* name;
    std::uint32_t base_faces;
    NamedMesh (*mesh)();
};

NamedMesh sphere()
{
    return NamedMesh{"uv-sphere-4096", make_uv_sphere(33, 64).value()};
}

NamedMesh cow()
{
    return source_mesh(kCow);
}

NamedMesh bunny()
{
    return source_mesh(kBunny);
}

/// Finest mesh of this many faces that our encoder makes of the public scan.
NamedMesh small_bunny()
{
    auto named = bunny();
    const std::string name = fmt::format("{}-of-{}", kSmallBunnyFaces, named.name);
    const test::TestModel& scan = test::test_model("for-" + name, named.mesh, 500);
    return coarser_mesh(name, scan, kSmallBunnyFaces);
}

constexpr std::array<Table1Case, 4> kCases{{{"sphere", 50, sphere},
                                            {"cow", 704, cow},
                                            {"bunny-37k", 500, small_bunny},
                                            {"bunny-69k", 500, bunny}}};

/// Edges from here down to the lowest block.
std::uint32_t height_below(const AbTree& tree, TreeRef ref)
{
    if (ref.is_block())
    {
        return 0;
    }
    std::uint32_t highest = 0;
    const AbNode& node = tree.node(ref.index());
    for (std::uint32_t child = 0; child < kNodeChildren; ++child)
    {
        if (((node.mask >> child) & 1U) != 0)
        {
            highest = std::max(highest, height_below(tree, node.children[child]));
        }
    }
    return highest + 1;
}

/// Edges from the root down to the lowest face of the paper's binary tree. Every face must be
/// active up to the root; otherwise empty.
std::optional<std::uint32_t> binary_height(Model& model)
{
    const std::vector<FaceId> order = test::faces_by_path(model);
    BinaryAbTree tree(order);
    for (std::uint32_t i = 0; i < model.forest.capacity(); ++i)
    {
        if (const FaceId face = model.forest.face(PrimId{i}).id; !face.is_none())
        {
            tree.set(face);
        }
    }
    tree.refit();
    std::uint32_t highest = 0;
    for (const FaceId face : order)
    {
        std::uint32_t depth = 0;
        std::uint32_t node = tree.leaf_of(face);
        for (; tree.parent(node) != BinaryAbTree::kNone; node = tree.parent(node))
        {
            if (tree.status(node) != BinaryAbTree::Status::active)
            {
                return std::nullopt;
            }
            ++depth;
        }
        highest = std::max(highest, depth);
    }
    return highest;
}

void run_case(const CaseContext& context, const Table1Case& test_case)
{
    const auto named = test_case.mesh();
    const Scene scene{test::test_model(named.name, named.mesh, test_case.base_faces), nullptr};
    StaticModel refined(scene);
    Model& model = refined.model();
    const auto binary = binary_height(model);
    if (!binary)
    {
        throw Failure(scene.model.name + ": the binary tree has a face below an inactive node");
    }
    CaseRows table(context.rows, context.common_row(scene.model.name));
    const HeaderFields& fields = model.header.fields();
    table.add("faces", fields.source_faces, "");
    table.add("vertices", fields.source_vertices, "");
    table.add("records", fields.records, "");
    table.add("base faces", fields.base_faces, "", test_case.base_faces);
    table.add("base vertices", fields.base_vertices, "");
    table.add("height, 8-wide", height_below(refined.tree(), refined.tree().root()), "");
    table.add("height, binary", *binary, "");
}

std::vector<Case> table1_cases()
{
    std::vector<Case> cases;
    for (const Table1Case& one : kCases)
    {
        cases.push_back(make_case(one.name, When::always, run_case, one));
    }
    return cases;
}

} // namespace

Suite table1_suite()
{
    return {"table1", table1_cases};
}

} // namespace tactus::bench
