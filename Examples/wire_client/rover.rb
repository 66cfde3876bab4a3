# The rover of rover.py in another language, in short: no going on after a break.
#
#   protoc -I Libraries/Session --ruby_out=STUBS --grpc_out=STUBS \
#       --plugin=protoc-gen-grpc=/usr/bin/grpc_ruby_plugin Libraries/Session/dspace/proto/*.proto
#   ruby -I STUBS Examples/wire_client/rover.rb unix:/tmp/dspace rover.ppm
#
# Debian: protobuf-compiler, protobuf-compiler-grpc, ruby-grpc.
require "grpc"
require "securerandom"
require "dspace/proto/service_services_pb"

include Dspace::V1

STEPS, DT = 500, 0.01 # s
RADIUS, RATE = 3.0, 0.2 # of the circle [m], along it [rad/s]
WHEEL = 0.2 # radius [m]
ROVER, WHEELS = 10, [11, 12, 13, 14] # ids of frames, ours to choose
CORNERS = [[0.5, 0.45], [0.5, -0.45], [-0.5, 0.45], [-0.5, -0.45]]

# Commands in order; the replies come in the same order, in a thread of their own.
class Driver
  def initialize(address, name)
    stub = Dspace::V1::Dspace::Stub.new(address, :this_channel_is_insecure,
                                        channel_args: { "grpc.max_receive_message_length" => -1 })
    @requests, @replies, @number = Queue.new, Queue.new, 0
    @requests << DriveRequest.new(open: OpenDrive.new(protocol: "dspace.v1", client: name,
                                                      key: SecureRandom.bytes(16)))
    ours = Enumerator.new { |out| while (request = @requests.pop) do out << request end }
    @reader = Thread.new do
      stub.drive(ours) { |reply| @replies << reply }
    rescue GRPC::BadStatus => error
      @replies << error
    end
    raise "not opened" unless take.opened
  end

  def send(reply: false, **command)
    @number += 1
    @requests << DriveRequest.new(send: SendCommand.new(number: @number, no_reply: !reply,
                                                        command: Command.new(**command)))
    @number
  end

  def ask(**command)
    number = send(reply: true, **command)
    loop do
      done = take.done or next # an event of a viewer
      raise done.reply.error.message if done.reply&.error
      return done.reply if done.number == number && done.reply
    end
  end

  def close
    @requests << nil
    @reader.join
  end

  private

  def take
    message = @replies.pop
    raise message if message.is_a?(Exception)
    raise message.closed.error.message if message.closed
    message
  end
end

def vector(x, y, z) = Vector3.new(x: x, y: y, z: z)

def settings(frame, name, color, offset = nil)
  ObjectSettings.new(frame: frame, name: "#{name} #{frame}", offset: offset,
                     material: Material.new(color: Color.new(r: color[0], g: color[1], b: color[2])))
end

def frame(id, parent, name, place)
  { create_frame: CreateFrame.new(id: id, parent: parent, name: name,
                                  pose: Pose.new(position: vector(*place))) }
end

# Takes away what an earlier run has left: scenes stay in a server.
def clear(link)
  viewports = link.ask(list_viewports: ListViewports.new).viewports.name
  viewports.each { |name| link.send(remove_viewport: RemoveViewport.new(viewport: name)) }
  scenes = link.ask(list_scenes: ListScenes.new).scenes.name
  scenes.each { |name| link.send(scene: name, remove_scene: RemoveScene.new) }
end

def build(link)
  link.send(create_scene: CreateScene.new)
  link.send(**frame(ROVER, 0, "rover", [0.0, 0.0, WHEEL]))
  turn = Offset.new(rotation: Quaternion.new(w: Math.sqrt(0.5), x: Math.sqrt(0.5)))
  WHEELS.zip(CORNERS) do |id, (x, y)|
    link.send(**frame(id, ROVER, "wheel_#{id}", [x, y, 0.0]))
    link.send(create_primitive: CreatePrimitive.new(
      object: settings(id, "wheel", [0.15, 0.15, 0.16], turn),
      cylinder: CreatePrimitive::Cylinder.new(radius: WHEEL, height: 0.15)))
  end
  link.send(create_primitive: CreatePrimitive.new(
    object: settings(ROVER, "body", [0.85, 0.65, 0.25]), box: CreatePrimitive::Box.new(size: vector(1.2, 0.7, 0.25))))
  link.send(create_primitive: CreatePrimitive.new(
    object: settings(0, "ground", [0.62, 0.48, 0.38]), plane: CreatePrimitive::Plane.new(width: 20.0, height: 20.0)))
  link.send(set_camera: SetCamera.new(
    name: "main",
    projection: Projection.new(perspective: Projection::Perspective.new(vertical_fov_deg: 40.0)),
    mount: Mount.new(look_at: LookAt.new(eye: vector(7.0, -3.0, 4.0), target: vector(1.0, 2.5, 0.0)))))
  link.ask(create_viewport: CreateViewport.new(name: "view", camera: "main", width: 320, height: 240))
end

# Rows px py pz qw qx qy qz scale of the rover in the root and of its wheels in the rover.
def poses(time_s)
  along = RATE * time_s
  rows = [RADIUS * Math.sin(along), RADIUS * (1.0 - Math.cos(along)), WHEEL,
          Math.cos(along / 2), 0.0, 0.0, Math.sin(along / 2), 1.0]
  CORNERS.each do |x, y|
    turned = along * (RADIUS - y) / WHEEL
    rows += [x, y, 0.0, Math.cos(turned / 2), 0.0, Math.sin(turned / 2), 0.0, 1.0]
  end
  rows
end

link = Driver.new(ARGV[0], "ruby rover")
clear(link)
build(link)
(1..STEPS).each do |step|
  link.send(set_time: SetTime.new(time_s: step * DT))
  link.send(set_poses: SetPoses.new(frame: [ROVER, *WHEELS], pose: poses(step * DT)))
end
rows = link.ask(get_poses: GetPoses.new(frame: [ROVER, *WHEELS], relative_to: 1)).poses.pose
[ROVER, *WHEELS].zip(rows.each_slice(8)) { |id, row| puts [id, *row].join(" ") }
capture = link.ask(capture: Capture.new(viewport: "view", color: true, inline_data: true)).capture
pixels = capture.plane[0].data.unpack("C*").each_slice(4).flat_map { |r, g, b, _| [r, g, b] }
File.binwrite(ARGV[1], "P6 #{capture.width} #{capture.height} 255\n" + pixels.pack("C*"))
link.close
