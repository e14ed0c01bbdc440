#include "app/commands.h"
#include "app/environment.h"
#include "app/run_driver.h"
#include "scene/read_scene.h"

namespace sandflow {

void addRunCommand(CLI::App& app, Action& action)
{
    auto options = std::make_shared<RunOptions>();
    CLI::App* run = app.add_subcommand("run", "Simulate a scene into a run folder");
    run->add_option("scene", options->scenePath, "Scene file (TOML)")->required();
    run->add_option("--out", options->folder, "Run folder (default: runs/NAME-MODE)");
    run->add_option("--mode", options->mode, "surface-flow or dem")
        ->check(CLI::IsMember({"surface-flow", "dem"}));
    run->add_option("--frames", options->frames, "Stop after this many frames");
    run->add_option("--threads", options->threads, "Threads (default: all processors)");
    run->add_option("--simd", options->simd,
                    "Kernel: auto, scalar, sse4, avx2, avx512 (same results)");
    run->add_option("--seed", options->seed, "Seed, instead of the scene's");
    run->add_option("--set", options->overrides, "Another value for a scene key: KEY=VALUE")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    run->add_flag("--force", options->force, "Replace a run that is in the folder");
    run->add_flag("--no-frames", options->noFrames, "Write no picture files");
    run->add_flag("--all-grains", options->allGrains, "Buried grains in the picture files too");
    run->add_flag("--keep-states", options->keepStates, "Keep the state of every frame");
    run->add_option("--release-at-end", options->releaseSeconds,
                    "Then set all sand free for so many seconds and report how it moved; in dem "
                    "mode, for comparison, wipe its contacts' history")
        ->type_name("SECONDS")
        ->check(CLI::Range(1e-6, 1e6));
    run->add_flag("--no-skip", options->noSkip, "Leave out no work (no sleeping)");
    run->add_flag("--quiet", options->quiet, "Print the summary only");
    run->callback([options, &action] {
        action = [options] { return runScene(*options); };
    });
}

}  // namespace sandflow
