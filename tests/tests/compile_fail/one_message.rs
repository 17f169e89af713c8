hertzian::oscillator! {
    pub struct Model(x) {
        param k in 0..;
        param c = oops;
        ddot(x) + c*dot(x) + k*x^3 = cos(omega*t);
    }
}

hertzian::law! {
    pub struct Hertz(gap, k > 0) { gap > 0 => k*gap^1.5, else => 0 }
}

fn main() {
    let model = Model { k: 1.0, ..Model::default() };
    let _ = hertzian::FrequencyResponse::of(&model).from(0.5).to(1.5);
    let _ = model.generic();
    let _ = (model.clone() == model, Hertz);
}
