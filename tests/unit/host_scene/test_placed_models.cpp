// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene_names.hpp"
#include "tests/unit/host_scene/scene_files.hpp"
#include "transport/model_name.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

/// Scene files whose objects name their models, written and read.
namespace tactus::test
{
namespace
{

PlacedModels three_objects()
{
    PlacedModels scene;
    scene.files = {"cup.spm", "jar.spm"};
    scene.objects.push_back({"cup", 0, {}, {}});
    scene.objects.push_back(
        {"cup-2", 0, {{0.0, 0.6, 0.0, 0.8}, {1.0, -2.0, 3e-9}, 2.5}, {.stiffness_n_per_m = 800.0}});
    scene.objects.push_back({"jar",
                             1,
                             {{0.5, 0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}, 1e-3},
                             {700.0, 0.5, 0.25, 3.0, 1.5, 1e-4, 0.01}});
    return scene;
}

TEST(PlacedModels, are_read_as_they_were_written)
{
    const PlacedModels scene = three_objects();
    const SceneFiles files;
    const auto path = files.folder().write("scene.gltf", scene_text(scene));
    const auto sut = read_placed_models(path);
    ASSERT_TRUE(sut) << sut.error().text;
    ASSERT_EQ(sut.value().files.size(), 2U);
    EXPECT_EQ(sut.value().files[0], files.folder().path() / "cup.spm");
    EXPECT_EQ(sut.value().files[1], files.folder().path() / "jar.spm");
    ASSERT_EQ(sut.value().objects.size(), scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
    {
        const PlacedModel& read = sut.value().objects[i];
        const PlacedModel& written = scene.objects[i];
        EXPECT_EQ(read.name, written.name);
        EXPECT_EQ(read.model, written.model);
        EXPECT_EQ(read.pose.translation_m, written.pose.translation_m);
        EXPECT_NEAR(read.pose.scale, written.pose.scale, 1e-15 * written.pose.scale);
        for (std::size_t k = 0; k < 4; ++k)
        {
            EXPECT_NEAR(read.pose.rotation[k], written.pose.rotation[k], 1e-15);
        }
        EXPECT_EQ(read.material, written.material) << read.name;
    }
}

TEST(PlacedModels, leave_out_what_is_not_touched)
{
    auto document = nlohmann::json::parse(scene_text(three_objects()));
    document["nodes"][0]["extras"]["tactus"] = {{"touch", false}};
    const SceneFiles files;
    const auto sut = read_placed_models(files.folder().write("scene.gltf", document.dump()));
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().files.size(), 2U);
    EXPECT_EQ(sut.value().objects.size(), 2U);
    EXPECT_EQ(sut.value().objects[0].name, "cup-2");
}

TEST(PlacedModels, need_their_models_named)
{
    const SceneFiles files;
    const auto path = files.folder().write("scene.gltf", tetrahedron_scene().dump());
    const auto sut = read_placed_models(path);
    ASSERT_FALSE(sut);
    EXPECT_EQ(sut.error().text, path.string() +
                                    ": node 'thing' (nodes[0]) names no model in extras.tactus; "
                                    "build models from the scene's meshes with: spm_build " +
                                    path.string() + " -o FOLDER");
}

using Names = std::vector<std::string>;

TEST(UniqueNames, plain_names_keep_what_the_wire_takes)
{
    EXPECT_EQ(plain_name("Arm_2.left-b"), "Arm_2.left-b");
    EXPECT_EQ(plain_name("a b/c\n"), "a_b_c_");
    EXPECT_EQ(plain_name("Kugel \u00E4"), "Kugel_\u00E4");
    EXPECT_EQ(plain_name("Geh\u00E4use/\u65E5\u672C\u00A0\u202Ex"), "Geh\u00E4use_\u65E5\u672C__x");
    EXPECT_EQ(plain_name("a\xC3-\xFF"), "a_-_");
    EXPECT_EQ(plain_name(std::string(62, 'x') + "\u00E4"), std::string(62, 'x'));
    EXPECT_EQ(plain_name(""), "");
    EXPECT_EQ(plain_name(std::string(64, 'x')), std::string(63, 'x'));
}

TEST(UniqueNames, the_first_keeps_its_name_and_nobody_takes_anothers)
{
    EXPECT_EQ(unique_names(Names{}), Names{});
    EXPECT_EQ(unique_names(Names{"a", "b", "a", "a"}), (Names{"a", "b", "a-2", "a-3"}));
    EXPECT_EQ(unique_names(Names{"a", "a", "a-2", "a"}), (Names{"a", "a-3", "a-2", "a-4"}));
    EXPECT_EQ(unique_names(Names{"a-2", "a-2", "a", "a"}), (Names{"a-2", "a-2-2", "a", "a-3"}));
}

TEST(UniqueNames, long_names_give_way_to_their_numbers)
{
    const Names names(1100, std::string(63, 'x'));
    const Names unique = unique_names(names);
    EXPECT_EQ(unique[1], std::string(61, 'x') + "-2");
    EXPECT_EQ(std::set(unique.begin(), unique.end()).size(), names.size());
    for (const std::string& name : unique)
    {
        EXPECT_TRUE(is_valid_name(name)) << name;
    }
}

} // namespace
} // namespace tactus::test
