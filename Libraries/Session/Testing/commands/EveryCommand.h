// One valid instance of every command, for tests that walk the whole protocol. A new command needs
// an entry here: the tests name the one that has none.
#ifndef DSPACE_EVERY_COMMAND_H
#define DSPACE_EVERY_COMMAND_H

#include <string>
#include <vector>

namespace dspace::testing {

// Commands are v1::Command in protobuf's text format. FOLDER stands for a folder that the test may
// write into: it holds arm.urdf, array.gltf, ground.asc, box.obj, moon.tpc and tracks.json. VIEW is
// a viewport of 48 x 32 pixels.
struct CommandInstance {
  const char* command;             // the command's name is the name of its field
  std::vector<const char*> before; // given first, after Everything()
  // The reply may differ between two sessions in the same state: counters, times, paths of files.
  bool replyVaries = false;
};

// Makes a scene with something of every kind in it.
inline const std::vector<const char*>& Everything() {
  static const std::vector<const char*> commands = {
      R"(create_scene {})",
      R"(scene: "other" create_scene { no_lights: true })",
      R"(create_frame { id: 10 name: "base" pose { position { x: 1 y: 2 z: 0.5 } } })",
      R"(create_frame { id: 11 parent: 10 name: "mast" pose { position { z: 1 } } })",
      R"(create_primitive { object { id: 1 name: "box" frame: 11 } box { size { x: 1 y: 1 z: 1 } } })",
      R"(create_trail { object { id: 2 name: "trail" frame: 10 } capacity: 10 })",
      R"(append_trail { object: 2 point: [0, 0, 0, 1, 0, 0, 1, 1, 0] })",
      R"(create_primitive { object { id: 3 name: "tilt" } tilt { radius: 1 tilt_deg: 5 } })",
      R"(create_text { object { id: 4 name: "words" } text: "words" solid { height: 1 } })",
      R"(create_text { object { id: 5 name: "label" } text: "label" label { font_size: 20 } })",
      R"(create_stars { object { id: 9 name: "stars" }
           direction: "\x00\x00\x80\x3f\x00\x00\x00\x00\x00\x00\x00\x00" magnitude: "\x00\x00\x80\x3f" })",
      R"(create_trajectory { object { id: 12 name: "orbit" frame: 10 nature: ORNAMENTAL } most_points: 70
           path { conic { position { x: 7e6 } velocity { y: 7500 } mu: 3.986e14 } } begin_s: 0 end_s: 1000 })",
      R"(create_body { object { id: 13 name: "moon" offset { position { x: 4e8 } } } body: "moon" })",
      R"(create_mesh { object { id: 6 name: "wings" frame: 10 } level { mesh { part: "wing" primitive: POINTS
           position: "\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00" } } })",
      R"(load_robot { path: "FOLDER/arm.urdf" name: "arm" })",
      R"(import_nodes { import { object { name: "array" frame: 10 } level { path: "FOLDER/array.gltf" } }
           lights: true frame: [60, 61, 62, 63] })",
      R"(pose_nodes { base: 60 time_s: 1 })",
      R"(create_fragment { name: "parts" nature: PHYSICAL })",
      R"(create_fragment { name: "empty" nature: PHYSICAL })",
      R"(set_light { name: "lamp" kind: POINT position { z: 5 } })",
      R"(create_vantage { name: "side" })",
      R"(create_vantage { name: "spare" })",
      R"(set_camera { vantage: "side" name: "chase"
           mount { frame: 10 chase { offset { x: -5 z: 2 } smoothing_s: 1 } } })",
      R"(set_camera { vantage: "side" name: "still" mount { frame: 11 pose {} } })",
      R"(set_camera { vantage: "side" name: "pointing"
           mount { pointing { eye { x: -3 z: 4 } aim: 11 smoothing_s: 2 } } })",
      R"(set_camera { name: "eye" mount { look_at { eye { x: 6 y: -7 z: 5 } target { z: 1 } } } })",
      R"(open_terrain { name: "ground" path: "FOLDER/ground.asc" mode: CLIPMAP subdivisions: 5
           fill_holes: 4 build_overviews: false overview_cache: "" })",
      R"(add_terrain_layer { terrain: "ground" name: "dust" noise { octaves: 1 } })",
      R"(add_terrain_field { terrain: "ground" name: "soil" path: "FOLDER/ground.asc" })",
      R"(track_wheels { terrain: "ground" width: 0.3
           wheel { name: "left" contact: [-2, -2, 0, 0.1, 0, 1, -2, 0, 0.1, 3] } })",
      R"(create_telemetry { id: 1 name: "rover/power" unit: "W" })",
      R"(create_telemetry { id: 2 name: "rover/mode" kind: TEXT })",
      R"(create_telemetry { id: 3 name: "rover/lamp" kind: CHOICE label { value: 1 label: "on" } })",
      R"(set_telemetry { id: 1 value: 3 })",
      R"(set_telemetry_texts { id: 2 text: "idle" })",
      R"(log_event { kind: "note" text: "it begins" frame: 10 })",
      R"(ask_operator { name: "go" text: "Go on?" choice: "yes" choice: "no" })",
      R"(create_viewport { name: "VIEW" width: 48 height: 32 samples: 1 })",
      R"(set_text_table { viewport: "VIEW" name: "table" row { label: "a" value: "1" } font_size: 6 })",
      R"(set_color_bar { viewport: "VIEW" name: "bar" low: 0 high: 1 color { r: 1 } color { b: 1 }
           length: 16 font_size: 6 })",
      R"(create_viewport { name: "hidden" width: 16 height: 16 samples: 1 hidden: true })",
      R"(set_time { time_s: 2 })",
  };
  return commands;
}

inline const std::vector<CommandInstance>& EveryCommand() {
  static const std::vector<CommandInstance> commands = {
      {R"(scene: "third" create_scene {})", {}},
      {R"(scene: "other" remove_scene {})", {}},
      {R"(list_scenes {})", {}},
      {R"(set_time { time_s: 3.5 })", {}},
      {R"(get_time {})", {}},

      {R"(create_frame { id: 40 parent: 11 name: "tip" pose { position { x: 2 } } })", {}},
      {R"(create_frames { id: 41 name: "foot" name: "toe" parent: [10, 41]
           pose: [1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 1, 0, 0, 0.5] })",
       {}},
      {R"(remove_frame { frame: 40 })", {R"(create_frame { id: 40 parent: 11 name: "tip" })"}},
      {R"(reparent_frame { frame: 11 parent: 1 keep_world_pose: true })", {}},
      {R"(rename_frame { frame: 11 name: "tower" })", {}},
      {R"(set_poses { frame: 11 pose: [0, 0, 3, 1, 0, 0, 0, 1] })", {}},
      {R"(find_frame { path: "base/mast" })", {}},
      {R"(get_poses { frame: [10, 11] relative_to: 1 })", {}},
      {R"(list_frames {})", {}},
      {R"(follow_frames {})", {}},

      {R"(import_object { object { id: 50 name: "model" frame: 10 } level { path: "FOLDER/box.obj" } })",
       {}},
      {R"(import_nodes { import { object { name: "array" material { color { g: 1 } } }
            level { path: "FOLDER/array.gltf" } scale: 2 up: UP_Y } lights: true })",
       {}},
      {R"(pose_nodes { base: 60 animation: "turn" time_s: 0.5 })", {}},
      {R"(create_primitive { object { id: 50 name: "ball" } sphere { radius: 0.5 resolution: 8 } })",
       {}},
      {R"(set_primitive { object: 1 shape { sphere { radius: 0.7 resolution: 8 } } })", {}},
      {R"(create_trail { object { id: 50 name: "way" } capacity: 5 minimum_spacing: 0.1 })", {}},
      {R"(append_trail { object: 2 point: [2, 1, 0] })", {}},
      {R"(create_stars { object { id: 50 name: "more stars" frame: 10 }
           direction: "\x00\x00\x80\x3f\x00\x00\x00\x00\x00\x00\x00\x00" magnitude: "\x00\x00\x80\x3f"
           color_index: "\x00\x00\x80\x3f" look { gain: 100 faintest: 6 } })",
       {}},
      {R"(create_body { object { id: 50 name: "ringed" frame: 10 material { color { r: 1 g: 0.9 b: 0.8 } } }
           body: "saturn" ring { inner: 7e7 outer: 8e7 optical_depth: 1 }
           atmosphere { top: 1e5 rayleigh { x: 1e-6 y: 2e-6 z: 3e-6 } } })",
       {}},
      {R"(set_stars { object: 9 look { spread: 2 } })", {}},
      {R"(clear_trail { object: 2 })", {}},
      {R"(create_trajectory { object { id: 50 name: "seen between two bodies" frame: 10 nature: ORNAMENTAL }
            path { conic { position { x: 7e6 } velocity { y: 7500 z: 10 } mu: 3.986e14 } }
            axes { kind: ROTATING origin { conic { position { x: 7e6 } velocity { y: 7500 } mu: 3.986e14 } }
                   other { conic { position { x: -7e6 } velocity { y: -7500 } mu: 3.986e14 } } }
            begin_s: 0 end_s: 1000 tick_interval_s: 100 clock: SECONDS
            color_time: "\x00\x00\x00\x00\x00\x00\x00\x00" color_at: "\xff\x80\x00\xff"
            look { color { r: 1 g: 0.5 } before_s: 500 ahead: 0.5 } })",
       {}},
      {R"(set_trajectory { object: 12 look { fade: true before_s: 100 } })", {}},
      {R"(set_trajectory_frame { object: 12 frame: 40 rule { axis { z: 1 } second_axis { x: 1 } second_direction: MOTION } })",
       {R"(create_frame { id: 40 parent: 10 name: "craft" })"}},
      {R"(get_trajectory { object: 12 time: "\x00\x00\x00\x00\x00\x00\x00\x00" })", {}},
      {R"(get_orbit { object: 12 mu: 3.986e14 })", {}},
      {R"(create_mesh { object { id: 50 name: "sheet" frame: 10 } level { minimum_pixels: 0 mesh { part: "left"
            origin { x: 1e6 } position: "\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x3f\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x3f\x00\x00\x00\x00"
            material { color { r: 1 } } } } })",
       {}},
      {R"(set_mesh { object: 6 level { mesh { part: "wing" primitive: LINES
            position: "\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x3f\x00\x00\x00\x00\x00\x00\x00\x00" } } })",
       {}},
      {R"(get_mesh { object: 6 })", {}},
      {R"(set_part { object: 6 part: "wing" material { emissive { g: 1 } } visible: false })", {}},
      {R"(remove_object { object: 1 })", {}},
      {R"(set_object_visible { object: 1 visible: false })", {}},
      {R"(set_material { object: 1 material { color { r: 1 } opacity: 1 metallic: 0.5 roughness: 0.5
            reflectance { model: HAPKE single_scattering_albedo: 0.2 roughness_deg: 20 } } })",
       {}},
      {R"(set_shader { object: 1
            replacement { stage: FRAGMENT original: "//VTK::Light::Impl"
                          replacement: "//VTK::Light::Impl\n  fragOutput0.rgb *= tint;" }
            uniform { name: "tint" type: VECTOR3 value: [1, 0.5, 0] } })",
       {}},
      {R"(export_scene { path: "FOLDER/scene.glb" time_s: [0, 1] frame: 11
            pose: [0, 0, 3, 1, 0, 0, 0, 1, 0, 0, 4, 1, 0, 0, 0, 1] })",
       {}},
      {R"(set_object_offset { object: 1 offset { position { x: 0.5 } } })", {}},
      {R"(attach_object { object: 1 frame: 10 })", {}},
      {R"(move_to_fragment { object: 1 fragment: "parts" })", {}},
      {R"(find_object { name: "box" })", {}},
      {R"(describe_object { object: 1 })", {}},
      {R"(list_objects {})", {}},
      {R"(set_tilt { object: 3 tilt_deg: 20 })", {}},
      {R"(create_text { object { id: 50 name: "more" } text: "more" label { font_size: 16 } })",
       {}},
      {R"(set_text { object: 4 text: "other" })", {}},
      {R"(create_drawn { object { id: 50 name: "cloud" frame: 10 } drawer: "fog" parameters: "thick" })",
       {}},

      {R"(load_robot { path: "FOLDER/arm.urdf" name: "second" frame: 10 minimum_pixels: 50
          level { path: "FOLDER/arm.urdf" } })",
       {}},
      {R"(remove_robot { robot: "arm" })", {}},
      {R"(set_joints { robot: "arm" joint: 0 position: 30 })", {}},
      {R"(describe_robot { robot: "arm" })", {}},
      {R"(list_robots {})", {}},

      {R"(create_fragment { name: "signs" nature: ORNAMENTAL })", {}},
      {R"(remove_fragment { name: "empty" })", {}},
      {R"(set_fragment_visible { name: "parts" visible: false })", {}},
      {R"(list_fragments {})", {}},
      {R"(set_light { name: "lamp" kind: SPOT position { z: 6 } cone_deg: 20 })", {}},
      {R"(remove_light { name: "sun" })", {}},
      {R"(list_lights {})", {}},
      {R"(set_sun { sun { horizontal { azimuth_deg: 80 elevation_deg: -3 terrain: "ground"
            map_x: 103 map_y: 205 } radius_deg: 0.3 irradiance: 590 } })",
       {}},
      {R"(get_sun {})", {}},

      {R"(create_vantage { name: "top" })", {}},
      {R"(remove_vantage { name: "spare" })", {}},
      {R"(list_vantages {})", {}},
      {R"(set_camera { vantage: "side" name: "still" projection { orthographic { height: 4 } } })",
       {}},
      {R"(remove_camera { vantage: "side" name: "chase" })",
       {R"(set_active_camera { vantage: "side" name: "still" })"}},
      {R"(set_active_camera { vantage: "side" name: "still" })", {}},
      {R"(describe_camera { vantage: "side" name: "chase" })", {}},
      {R"(get_camera_pose { vantage: "side" name: "chase" relative_to: 10 })", {}},
      {R"(fit_camera { name: "eye" object: 1 frame: 10 margin: 0.2 aspect: 1.5 })", {}},

      {R"(create_viewport { name: "more" width: 16 height: 16 samples: 1 vantage: "side" })", {}},
      {R"(remove_viewport { viewport: "hidden" })", {}},
      {R"(style_terrain_in_viewport { viewport: "VIEW" terrain: "ground" style { ramp { opacity: 0.5
            member { nature: ORNAMENTAL } } contours { interval: 1 width: 1 opacity: 1 } } })",
       {}},
      {R"(resize_viewport { viewport: "VIEW" width: 40 height: 40 })", {}},
      {R"(move_viewport { viewport: "VIEW" x: 5 y: 6 })", {}},
      {R"(set_viewport { viewport: "VIEW" samples: 2 background { b: 1 } ornaments: false
            shadows: true shadow_cascades: 3 shadow_map_size: 512 shadow_distance: 50 fill: 0.5
            exposure: 2 automatic_exposure: true tone: FILMIC cascade_colors: true
            navigation: WALK eye_height: 2 walk_speed: 3 lens: "" })",
       {}},
      {R"(set_viewport_fragment { viewport: "VIEW" fragment: "physical" visible: false })", {}},
      {R"(set_text_table { viewport: "VIEW" name: "table" row { label: "b" value: "2" digits: 3 }
            font_size: 14 opacity: 1 background_opacity: 0.5 margin: 0 })",
       {}},
      {R"(remove_text_table { viewport: "VIEW" name: "table" })", {}},
      {R"(viewport_event { viewport: "VIEW" type: WHEEL x: 20 y: 15 wheel: 1 })", {}},
      {R"(capture { viewport: "VIEW" color: true depth: true label: true range: true
            inline_data: true })",
       {}},
      {R"(explain_viewport { viewport: "VIEW" })", {}},
      {R"(save_image { viewport: "VIEW" path: "FOLDER/view.jpg" quality: 90 })", {}},
      {R"(render { viewport: "VIEW" })", {}, true},
      {R"(pick { viewport: "VIEW" x: 24 y: 16 radius: 4 })", {}},
      {R"(describe_viewport { viewport: "VIEW" })", {}},
      {R"(list_viewports {})", {}},
      {R"(get_statistics {})", {}, true},
      {R"(set_color_bar { viewport: "VIEW" name: "bar" low: 0 high: 2 color { g: 1 } color { b: 1 }
            ticks: 3 length: 20 thickness: 4 font_size: 6 opacity: 1 background_opacity: 0.5 })",
       {}},
      {R"(remove_color_bar { viewport: "VIEW" name: "bar" })", {}},

      {R"(open_terrain { name: "second" path: "FOLDER/ground.asc" mode: TRIANGLES frame: 10 band: 1
            triangle_budget: 1000 build_overviews: false overview_cache: "" })",
       {}},
      {R"(remove_terrain { terrain: "ground" })", {}},
      {R"(focus_terrain { terrain: "ground" point: [1, 1] radius: 3 })", {}},
      {R"(query_terrain { terrain: "ground" point: [0.5, 0.25, -2, -2] height: true normal: true
            slope: true })",
       {}},
      {R"(add_terrain_field { terrain: "ground" name: "hazard" path: "FOLDER/ground.asc"
            extent: [101, 209, 109, 201] band: 1 units: "W/m2" nearest: true })",
       {}},
      {R"(remove_terrain_field { terrain: "ground" name: "soil" })", {}},
      {R"(list_terrain_fields { terrain: "ground" })", {}},
      {R"(locate_terrain { terrain: "ground" point: [1, 2, 3] map: true })", {}},
      {R"(convert_terrain { terrain: "ground" point: [1, 2, 3] to_map: true })", {}},
      {R"(describe_terrain { terrain: "ground" })", {}, true},
      {R"(list_terrains {})", {}},
      {R"(style_terrain { terrain: "ground" ramp { opacity: 0.5 } contours { interval: 1 width: 1 opacity: 1 }
            grid { interval: 2 width: 1 opacity: 1 } grid_labels { font_size: 6 background_opacity: 0.5 } })",
       {}},
      {R"(intersect_terrain { terrain: "ground" ray: [0.5, 0.25, 100, 0, 0, -1] })", {}},
      {R"(describe_terrain_style { terrain: "ground" })",
       {R"(style_terrain { terrain: "ground" ramp { opacity: 0.5 } })"}},
      {R"(track_wheels { terrain: "ground" width: 0.3
            wheel { name: "right" contact: [-2, 2, 0, 0.1, 0, 1, 2, 0, 0.1, 3] } })",
       {}},
      {R"(clear_tracks { terrain: "ground" })", {}},
      {R"(save_tracks { terrain: "ground" path: "FOLDER/saved.json" })", {}},
      {R"(load_tracks { terrain: "ground" path: "FOLDER/tracks.json" })",
       {R"(save_tracks { terrain: "ground" path: "FOLDER/tracks.json" })",
        R"(clear_tracks { terrain: "ground" })"}},
      {R"(restore_tracks { terrain: "ground" stroke { name: "third" width: 0.3 wall: 0.02
            place: [-1, 1, 1, 1] rolled: [0, 2] heading: [0, 0] sinkage: [0.05, 0.05] } })",
       {}},
      {R"(build_terrain_cache { folder: "FOLDER/cache" path: "FOLDER/ground.asc" band: 1 })",
       {},
       true},
      {R"(list_terrain_cache { folder: "FOLDER/cache" })", {}, true},
      {R"(clear_terrain_cache { folder: "FOLDER/cache" })", {}, true},
      {R"(verify_terrain_cache { folder: "FOLDER/cache" })", {}, true},
      {R"(add_terrain_layer { terrain: "ground" name: "sand" noise { octaves: 6 contrast: 0.25 }
            opacity: 0.5 position: 0 })",
       {}},
      {R"(change_terrain_layer { terrain: "ground" name: "dust" opacity: 0.25 position: 0 })", {}},
      {R"(remove_terrain_layer { terrain: "ground" name: "dust" })", {}},
      {R"(list_terrain_layers { terrain: "ground" })", {}, true},

      {R"(create_telemetry { id: 7 name: "rover/heater" unit: "Cel" description: "of the battery" })",
       {}},
      {R"(set_telemetry_limits { id: 1 limits { alarm_high: 9 } })", {}},
      {R"(set_telemetry { id: 1 value: 5 })", {}},
      {R"(set_telemetry_texts { id: 2 text: "drive" })", {}},
      {R"(remove_telemetry { id: 1 })", {}},
      {R"(list_telemetry {})", {}},

      {R"(log_event { kind: "contact" text: "ground" })", {}},
      {R"(ask_operator { name: "stop" text: "Stop?" })", {}},
      {R"(close_question { name: "go" answer: "yes" from: "operator" })", {}},
      {R"(list_events {})", {}},
      {R"(list_questions {})", {}},

      {R"(load_kernels { path: "FOLDER/moon.tpc" })", {}},
      {R"(unload_kernels {})", {R"(load_kernels { path: "FOLDER/moon.tpc" })"}},
      {R"(list_kernels {})", {}},
      {R"(set_frame_motion { frame: 40 place { body: "moon" axes: "IAU_MOON" } parent { body: "earth" }
           correction: "LT" })",
       {R"(create_frame { id: 40 name: "moon" })"}},
      {R"(set_sun_motion { place { body: "moon" site { longitude_deg: 29 latitude_deg: -84 } } })",
       {}},
      {R"(convert_times { text: "2026-11-01T00:00" time_s: 0 decimals: 3 })", {}},
      {R"(turn_frames { from: "J2000" to: "IAU_MARS" time_s: [0, 100] rates: true })", {}},
      {R"(find_sub_points { body: "mars" observer: "earth" })", {}},

      {R"(measure_geodesics { ellipsoid { axes { equatorial_radius: 1737400 } } start: [1, 2] end: [3, 4] })",
       {}},
      {R"(follow_geodesics { start: [1, 2] azimuth_deg: 30 distance: 1000 })", {}},
      {R"(measure_polygon { ellipsoid { axes { equatorial_radius: 1737400 } } place: [1, 2, 3, 4, 5, 1] })",
       {}},
      {R"(get_grid_references { place: [177, 83.8] mgrs_precision: 4 })", {}},
      {R"(find_grid_references { mgrs: "38SMB4488" })", {}},
      {R"(get_geoid_heights { place: [1, 2] geoid: "egm96_15.gtx" })", {}},

      // Without obstacles, so that no limit of the deadline or of the azimuths takes time.
      {R"(line_of_sight { measuring { no_terrain: true no_objects: true hidden_fragment: "parts" deadline_s: 30 }
           pair { from_site { terrain: "ground" map_x: 105.5 map_y: 205.25 height: 2 } to { frame: 11 position { z: 9 } } }
           wavelength: 0.1 without_object: 1 })",
       {}},
      {R"(lit_area { measuring { no_terrain: true no_objects: true } object: 1 samples: 16 efficiency: 0.3 sun { direction { z: 1 } } })",
       {}},
      {R"(horizon { measuring { no_terrain: true no_objects: true }
           site { terrain: "ground" map_x: 105.5 map_y: 205.25 height: 2 } azimuths: 8 without_object: 1 })",
       {}},
      {R"(track_sky { place { celestial { body: "moon" site { longitude_deg: 29 latitude_deg: -84 } } }
           target { body: "earth" station { longitude_deg: -116.9 latitude_deg: 35.4 } } time_s: [0, 100] })",
       {}},
      {R"(find_contacts { place { celestial { body: "moon" site { longitude_deg: 29 latitude_deg: -84 } } }
           target { body: "sun" upper: true } mask { elevation_deg: [0, 1] } end_s: 1e5 step_s: 3600 deadline_s: 30 })",
       {}},
      {R"(profile_power { place { celestial { body: "moon" site { longitude_deg: 29 latitude_deg: -84 } } }
           panel { area: 1 tracking: VERTICAL efficiency: 0.3 } battery { capacity_wh: 10 load: 1 } end_s: 1e5 })",
       {}},
      {R"(await_work { work: 1 wait_s: 30 })",
       {R"(horizon { measuring { no_terrain: true no_objects: true wait_s: 0 } place { frame: 11 } azimuths: 8 })"}},
      {R"(horizon_map { terrain: "ground" area { extent: [102, 208, 108, 202] } height: 2 azimuths: 8
           file { path: "FOLDER/horizon.tif" replace: true threads: 1 } })",
       {},
       true},
      {R"(viewshed { site { terrain: "ground" map_x: 105.5 map_y: 205.25 height: 2 } target_height: 1 radius: 100
           quantity: [VISIBLE, LEAST_HEIGHT, COUNT] area { extent: [102, 208, 108, 202] }
           file { path: "FOLDER/view.tif" replace: true threads: 1 } })",
       {},
       true},
      {R"(illumination_map { horizon_path: "FOLDER/horizons.tif" terrain: "ground" step_s: 60
           quantity: [LIT_FRACTION, EARTH_FRACTION] sun_position: [1.5e11, 0, 1e10] earth_position: [4e8, 0, 0]
           file { path: "FOLDER/lit.tif" replace: true threads: 1 } })",
       {R"(horizon_map { terrain: "ground" area { extent: [102, 208, 108, 202] } azimuths: 8
           file { path: "FOLDER/horizons.tif" replace: true } })"},
       true},
      {R"(simulate_image { camera { camera: "eye" width: 24 height: 16 } color: true range: true label: true
           tile_width: 24 tile_height: 16 samples: 1 exposure: 2 inline_data: true })",
       {}},
      {R"(project_points { camera { camera: "eye" width: 24 height: 16 } frame: 10 point: [0, 0, 1] })",
       {}},
      {R"(unproject_pixels { camera { model: "{\"model\": {\"type\": \"pinhole\", \"focal\": [9, 9], \"center\": [5, 5], \"width\": 11, \"height\": 11}}"
           own_pose: true frame: 10 } pixel: [5, 5] })",
       {}},
      {R"(scan_ranges { measuring { hidden_fragment: "parts" deadline_s: 30 } place { frame: 11 position { z: 9 } }
           directions { direction: [0, 0, -1, 1, 0, -3] } without_object: 2 first_beam: 4
           sensor { report: MEAN minimum_range: 0.1 divergence_deg: 1 rays: 7 noise: 0.01
             noise_fraction: 1e-3 drop_out: 0.1 greatest_incidence_deg: 80 least_intensity: 1e-9 seed: 3 scan: 1
             terrain_albedo: 0.3 } })",
       {}},
      {R"(ephemeris { target: "moon" observer: "earth" time_s: [0, 100] correction: APPARENT })",
       {}},
      {R"(sky_state { celestial { body: "moon" site { longitude_deg: 29 latitude_deg: -84 } }
           target: ["sun", "earth"] })",
       {}},
  };
  return commands;
}

} // namespace dspace::testing

#endif
