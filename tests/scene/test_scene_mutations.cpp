#include "scene/write_scene.h"

#include "random_scene.h"
#include "scene_support.h"

#include <random>

namespace sandflow {
namespace {

/// Spoils a text in one to four places, as a slip of the hand, a cut-off copy or a bad disk would.
class Mutator {
public:
    explicit Mutator(std::uint64_t seed) : bits_(seed) {}

    std::string mutate(std::string text)
    {
        for (auto changes = 1 + below(4); changes > 0; --changes) {
            change(text);
        }
        return text;
    }

private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : (bits_() >> 11) % end; }

    std::string snippet()
    {
        static const std::string snippets[] = {"nan",
                                               "-inf",
                                               "1e999",
                                               "-1",
                                               "0",
                                               "1e-400",
                                               "99999999999999999999",
                                               "[",
                                               "]",
                                               "[[",
                                               "]]",
                                               "{",
                                               "}",
                                               "=",
                                               "\"",
                                               "'''",
                                               "\"\"\"",
                                               "\n",
                                               "\r\n",
                                               "#",
                                               ".",
                                               ",",
                                               "true",
                                               "\\u0000",
                                               "_",
                                               "0x7fffffffffffffff",
                                               "1979-05-27T07:32:00Z",
                                               "[emitters]",
                                               "[[solids]]\n",
                                               "\xff",
                                               "\xc3",
                                               "kind = \"slot\"\n",
                                               "shape = \"mesh\"\n",
                                               "emitters = []\n",
                                               "[[grains]]\n",
                                               "\0"};
        return snippets[below(std::size(snippets))];
    }

    void change(std::string& text)
    {
        const auto at = below(text.size());
        const auto length = below(12);
        switch (below(7)) {
            case 0:
                text.insert(at, 1, static_cast<char>(below(256)));
                break;
            case 1:
                text.erase(at, 1 + length);
                break;
            case 2:
                text.insert(at, snippet());
                break;
            case 3:
                text.insert(at, text.substr(below(text.size()), 4 * length));
                break;
            case 4:
                text.replace(at, std::min(length, text.size() - at), snippet());
                break;
            case 5:
                dropOrRepeatLine(text);
                break;
            default:
                if (below(8) == 0) {
                    text.resize(at);
                } else if (at < text.size()) {
                    text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
                }
        }
    }

    void dropOrRepeatLine(std::string& text)
    {
        const auto begin = text.rfind('\n', below(text.size()));
        if (begin == std::string::npos) {
            return;
        }
        const auto end = std::min(text.find('\n', begin + 1), text.size());
        if (below(2) == 0) {
            text.erase(begin, end - begin);
        } else {
            text.insert(begin, text.substr(begin, end - begin));
        }
    }

    std::mt19937_64 bits_;
};

/// A mutated text is either a scene, which then survives a round trip, or refused in one line.
/// Returns whether it was a scene.
bool judge(const std::string& text)
{
    try {
        const Scene scene = parseScene(text, "m.toml");
        EXPECT_FALSE(scene.emitters.empty());
        EXPECT_EQ(writeScene(parseScene(writeScene(scene), "m.toml")), writeScene(scene));
        return true;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with("m.toml:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    } catch (const std::exception& error) {
        ADD_FAILURE() << "neither a scene nor an InputError: " << error.what() << "\nfrom\n"
                      << text;
    }
    return false;
}

TEST(SceneMutations, ASpoiltFloorIsASceneOrAnInputError)
{
    const std::string floor = readText(kSceneDir + "floor.toml");
    Mutator mutator(20240501);
    int scenes = 0;
    for (int i = 0; i < 10000; ++i) {
        scenes += judge(mutator.mutate(floor)) ? 1 : 0;
    }
    // Both outcomes must be common, or the loop would test nothing.
    EXPECT_GT(scenes, 500);
    EXPECT_LT(scenes, 9500);
}

TEST(SceneMutations, ASpoiltSceneWithEveryKeyIsASceneOrAnInputError)
{
    Mutator mutator(7);
    int scenes = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        scenes += judge(mutator.mutate(writeScene(RandomScene(i / 20).make()))) ? 1 : 0;
    }
    EXPECT_GT(scenes, 50);
    EXPECT_LT(scenes, 1900);
}

TEST(SceneMutations, ASpoiltOverrideIsASceneOrAnInputError)
{
    const std::string overrides[] = {"emitters[0].rate=5000", "gravity=[0, 0, -1.62]", "mode=dem",
                                     "solids[0].rough=false", "grains={radius=0.004}"};
    const std::string floor = kJet + "[[solids]]\nshape = \"plane\"\n";
    Mutator mutator(99);
    int scenes = 0;
    for (std::size_t i = 0; i < 10000; ++i) {
        const std::string text = mutator.mutate(overrides[i % std::size(overrides)]);
        try {
            parseScene(floor, "m.toml", {text});
            ++scenes;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_TRUE(message.starts_with("--set ") || message.starts_with("m.toml:")) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "neither a scene nor an InputError: " << error.what() << " from "
                          << text;
        }
    }
    EXPECT_GT(scenes, 100);
    EXPECT_LT(scenes, 9900);
}

}  // namespace
}  // namespace sandflow
