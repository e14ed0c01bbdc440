#version 3.7;
// One picture of a run. Copied into the run's folder, where it finds
//   run_scene.inc      constants, camera and solids of that run (generated)
//   frame_NNNNNN.inc   the grains of one frame (generated)
//   materials.inc, lights.inc
// Lengths are in mean grain radii, axes are (x, z, y) of the simulator.

// 0 preview, 1 movie, 2 final; on the command line: Declare=Quality=2
#ifndef (Quality) #declare Quality = 1; #end

// Before any colour: sRGB values are turned into light by it. Within a pane, light that enters at
// its edge is reflected some twenty times; a smaller trace level leaves the edges black.
global_settings { assumed_gamma 1.0 max_trace_level 24 }

#include "run_scene.inc"

#macro FrameFile(N) concat("frame_", str(N, -6, 0), ".inc") #end

// In an animation POV-Ray counts the frames. A plain render has frame_number 0 and shows the last
// frame that is there, so that a run can be looked at before it has ended.
#declare FrameNumber = frame_number;
#if (FrameNumber = 0)
  #declare FrameNumber = NFrames;
  #while (FrameNumber > 0 & !file_exists(FrameFile(FrameNumber)))
    #declare FrameNumber = FrameNumber - 1;
  #end
#end
#declare RunTime = FrameNumber / FramesPerSecond;

#include "materials.inc"
#include "lights.inc"

camera {
  location CameraPosition
  right x * image_width / image_height
  up y
  angle CameraAngle
  look_at CameraLookAt
}

RunSolids()
#include FrameFile(FrameNumber)
