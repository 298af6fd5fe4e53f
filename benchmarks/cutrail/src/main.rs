//! Cuts a stock along poses with cutrail: `cut-along-poses STOCK.obj POSES.txt LEFT.obj`.
//!
//! The second file has the lines `tolerance T`, `cutter DIAMETER CORNER FLUTE`, `shank DIAMETER LENGTH`,
//! `holder DIAMETER LENGTH`, and `pose x y z i j k` for each point of the path.  What is left goes to the third file.
//! A line is printed for each collision of shank or holder: number of the pose that the motion arrives at, and volume.

use std::error::Error;

use cutrail::{Engine, EngineOptions, Holder, ManifoldKernel, MotionSegment, Pose, Shank, StockShape, Tool, TriMesh};

fn main() -> Result<(), Box<dyn Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let stock = StockShape::Mesh(TriMesh::read_file(&names[0])?);
    let text = std::fs::read_to_string(&names[1])?;
    let mut poses = Vec::new();
    let (mut tool, mut options) = (Tool::flat_end_mill(1.0, 1.0), EngineOptions::default().with_collision_check());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next().unwrap_or("");
        let v: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
        match kind {
            "tolerance" => options.sweep_tolerance = v[0],
            "cutter" => {
                tool = if v[1] == 0.0 {
                    Tool::flat_end_mill(v[0], v[2])
                } else if v[1] == 0.5 * v[0] {
                    Tool::ball_end_mill(v[0], v[2])
                } else {
                    Tool::bull_nose_end_mill(v[0], v[1], v[2])
                }
            }
            "shank" => tool = tool.with_shank(Shank { diameter: v[0], length: v[1] }),
            "holder" => tool = tool.with_holder(Holder { diameter: v[0], length: v[1] }),
            "pose" => poses.push(Pose::new([v[0], v[1], v[2]], [v[3], v[4], v[5]])),
            _ => return Err(format!("line not understood: {line}").into()),
        }
    }
    let mut engine = Engine::new(ManifoldKernel, &[stock], options)?;
    for (k, pair) in poses.windows(2).enumerate() {
        let report = engine.cut(&tool, &MotionSegment::linear(pair[0], pair[1]))?;
        if let Some(hit) = report.collision {
            println!("collision {} {}", k + 1, hit.volume);
        }
    }
    println!("removed {}", engine.history().iter().map(|one| one.removed_volume).sum::<f64>());
    engine.merged_mesh()?.write_file(&names[2])?;
    Ok(())
}
