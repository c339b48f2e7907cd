//! Writes the meshes and constraints of `tests/data`: `cargo run -p freebound-testkit --example data`.

fn main() {
    let folder = freebound_testkit::data_folder();
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    for (name, bytes) in freebound_testkit::data_files() {
        std::fs::write(folder.join(&name), &bytes).expect("the file can be written");
        println!("{:>6} bytes: {name}", bytes.len());
    }
}
