// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/test_model.hpp"

#include <string>
#include <vector>

namespace tactus::bench
{

/// File of a bumpy sphere, opened and decoded.
struct OpenedModel
{
    explicit OpenedModel(std::uint32_t faces, std::uint32_t base_faces)
        : model(test::test_model("bumpy-sphere-" + std::to_string(faces),
                                 make_shape(Shape::bumpy_sphere, faces).value(), base_faces))
        , store(ModelStore::open(model.path).value())
        , decoded(DecodedModel::decode(store, damage))
    {
    }

    const test::TestModel& model;
    ModelStore store;
    std::vector<std::string> damage; ///< Empty; a test model is sound.
    DecodedModel decoded;
};

} // namespace tactus::bench
