// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/encoded_model.hpp"

#include "tests/golden/golden_model.hpp"

#include <stdexcept>

namespace tactus
{

namespace
{

std::unique_ptr<EncodedModel> encode_source(const std::string& name,
                                            const Result<TriangleMesh, Refusal>& mesh,
                                            unsigned position_bits)
{
    if (!mesh)
    {
        throw std::runtime_error(mesh.error().text);
    }
    return encode_source(name, mesh.value(), 100, position_bits);
}

std::unique_ptr<EncodedModel> encode_shape(const std::string& name, std::uint32_t faces,
                                           unsigned position_bits)
{
    return encode_source(name, make_shape(*parse_shape(name), faces), position_bits);
}

} // namespace

std::unique_ptr<EncodedModel> encode_source(std::string name, const TriangleMesh& mesh,
                                            std::uint32_t base_faces, unsigned position_bits)
{
    PrepareOptions options;
    options.position_bits = position_bits;
    auto prepared = prepare_mesh(mesh, options);
    if (!prepared)
    {
        throw std::runtime_error(prepared.error().text);
    }
    auto simplification = simplify(prepared.value().mesh, {base_faces, 1, {}});
    if (!simplification)
    {
        throw std::runtime_error(simplification.error().text);
    }
    return encode_mesh(std::move(name), std::move(prepared).value(),
                       std::move(simplification).value(), position_bits);
}

std::unique_ptr<EncodedModel> encode_mesh(std::string name, PreparedMesh prepared,
                                          Simplification simplification, unsigned position_bits)
{
    auto model = std::make_unique<EncodedModel>();
    model->name = std::move(name);
    model->prepared = std::move(prepared);
    model->simplification = std::move(simplification);
    const auto written = write_spm(model->path(), model->prepared, model->simplification,
                                   {position_bits, 500, std::nullopt});
    if (!written)
    {
        throw std::runtime_error(written.error().text);
    }
    model->fields = written.value();
    auto store = ModelStore::open(model->path());
    if (!store)
    {
        throw std::runtime_error(store.error().text);
    }
    model->store = std::make_unique<ModelStore>(std::move(store).value());
    std::vector<std::string> damage;
    model->decoded = std::make_unique<DecodedModel>(DecodedModel::decode(*model->store, damage));
    if (!damage.empty())
    {
        throw std::runtime_error(damage.front());
    }
    return model;
}

const std::vector<std::unique_ptr<EncodedModel>>& sample_models()
{
    static const std::vector<std::unique_ptr<EncodedModel>> models = []
    {
        std::vector<std::unique_ptr<EncodedModel>> made;
        PreparedMesh golden = make_golden_mesh();
        Simplification collapsed = collapse_plainly(golden.mesh, 16);
        made.push_back(encode_mesh("golden", std::move(golden), std::move(collapsed), 16));
        made.push_back(encode_shape("bumpy-sphere", 3'000, 16));
        made.push_back(encode_shape("terrain", 4'000, 16));
        made.push_back(encode_shape("gear", 2'000, 20));
        made.push_back(encode_source("soup", make_triangle_soup(700, 1), 16));
        return made;
    }();
    return models;
}

} // namespace tactus
