// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/encoded_model.hpp"

#include "tests/golden/golden_model.hpp"

#include <stdexcept>
#include <utility>

namespace tactus
{
namespace
{

template <Shape shape, std::uint32_t faces>
std::optional<TriangleMesh> shaped()
{
    return make_shape(shape, faces).value();
}

template <std::size_t index>
std::optional<TriangleMesh> known()
{
    return test::read_known(test::kKnownMeshes[index]);
}

} // namespace

EncodedModel::EncodedModel(test::MadeModel made) : MadeModel(std::move(made))
{
    auto opened = ModelStore::open(path);
    if (!opened)
    {
        throw std::runtime_error(opened.error().text);
    }
    store = std::make_unique<ModelStore>(std::move(opened).value());
    std::vector<std::string> damage;
    decoded = std::make_unique<DecodedModel>(DecodedModel::decode(*store, damage));
    if (!damage.empty())
    {
        throw std::runtime_error(damage.front());
    }
}

std::unique_ptr<EncodedModel> encode_source(std::string name, const TriangleMesh& mesh,
                                            std::uint32_t base_faces)
{
    return std::make_unique<EncodedModel>(test::make_model(std::move(name), mesh, base_faces));
}

const std::vector<std::unique_ptr<EncodedModel>>& sample_models()
{
    static const std::vector<std::unique_ptr<EncodedModel>> models = []
    {
        std::vector<std::unique_ptr<EncodedModel>> made;
        const auto add = [&](test::MadeModel model)
        { made.push_back(std::make_unique<EncodedModel>(std::move(model))); };
        PreparedMesh golden = make_golden_mesh();
        Simplification collapsed = collapse_plainly(golden.mesh, 16);
        add(test::make_model("golden", std::move(golden), std::move(collapsed), {}));
        add(test::make_model("bumpy-sphere", *shaped<Shape::bumpy_sphere, 3'000>(), 100));
        add(test::make_model("terrain", *shaped<Shape::terrain, 4'000>(), 100));
        add(test::make_model("gear", *shaped<Shape::gear, 2'000>(), 100, 20));
        add(test::make_model("soup", make_triangle_soup(700, 1).value(), 100));
        return made;
    }();
    return models;
}

std::unique_ptr<EncodedModel> SampleMesh::encode() const
{
    const auto mesh = make();
    return mesh ? encode_source(name, *mesh, base_faces) : nullptr;
}

std::vector<SampleMesh> generated_meshes()
{
    return {{"bumpy_sphere", shaped<Shape::bumpy_sphere, 20'000>, 100},
            {"torus", shaped<Shape::torus, 3'000>, 100},
            {"terrain", shaped<Shape::terrain, 3'000>, 100},
            {"gear", shaped<Shape::gear, 3'000>, 100},
            {"thin_plate", [] { return std::optional(make_thin_plate(25, 2e-5).value()); }, 60},
            {"needles", [] { return std::optional(make_uv_sphere(10, 200).value()); }, 100}};
}

std::vector<SampleMesh> known_meshes()
{
    std::vector<SampleMesh> meshes = smaller_known_meshes();
    meshes.push_back({"igea", known<4>, 500});
    return meshes;
}

std::vector<SampleMesh> smaller_known_meshes()
{
    return {{"cow", known<0>, 100},
            {"teapot", known<1>, 100},
            {"fandisk", known<2>, 100},
            {"bunny", known<3>, 500}};
}

} // namespace tactus
