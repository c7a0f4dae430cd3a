// SPDX-License-Identifier: GPL-3.0-or-later
// A Flamenco 3 job type: bakes and verifies the seas of one shot in portions, and renders each portion as soon
// as its frames are verified. Flamenco's manager takes it from its folder "scripts".

const SHOT = "@SHOT@"; // written in by `ocean_tweak job --form flamenco`

const JOB_TYPE = {
    label: SHOT.label,
    description: "Bakes and verifies the seas of a shot, and renders from them",
    settings: [
        { key: "frames", type: "string", required: true, default: SHOT.frames,
          description: "Frames of the shot. Examples: '47', '1-250', '3, 5-10'" },
        { key: "chunk_size", type: "int32", default: SHOT.chunk, propargs: { min: 1 }, visible: "submission",
          description: "Frames in a task of baking or verifying" },
        { key: "job_folder", type: "string", subtype: "dir_path", required: true, default: SHOT.folder,
          visible: "submission", description: "Folder that this job type was written to, with the seas in it" },
        { key: "cache", type: "string", subtype: "dir_path", required: true, default: SHOT.cache,
          description: "Folder of the baked frames; each sea gets one of its own in it" },
        { key: "program", type: "string", required: true, default: SHOT.program, visible: "submission",
          description: "What bakes, as the workers call it" },
    ].concat(SHOT.render ? [
        { key: "render_chunk_size", type: "int32", default: SHOT.render.chunk, propargs: { min: 1 },
          visible: "submission", description: "Frames in a task of rendering" },
        { key: "pictures", type: "string", subtype: "dir_path", required: true, default: SHOT.render.pictures,
          description: "Folder for the pictures" },
        { key: "blendfile", type: "string", required: true, visible: "web",
          description: "The .blend file to render" },
    ] : []),
};

function compileJob(job) {
    const settings = job.settings;
    const portions = frameChunker(settings.frames, settings.chunk_size);
    // verified[i] holds the tasks after which the frames of portion i can be rendered
    const verified = portions.map(() => []);
    for (const sea of SHOT.seas) {
        portions.forEach((frames, index) => {
            const bake = bakingTask(`bake-${sea.name}-${frames}`, sea.bake, settings, frames);
            job.addTask(bake);
            const verify = bakingTask(`verify-${sea.name}-${frames}`, sea.verify, settings, frames);
            verify.addDependency(bake);
            job.addTask(verify);
            verified[index].push(verify);
        });
    }
    if (SHOT.render) {
        addRenderTasks(job, verified);
    }
}

function bakingTask(name, args, settings, frames) {
    const task = author.Task(name, "misc");
    task.addCommand(author.Command("exec", { exe: settings.program, args: filled(args, settings, frames) }));
    return task;
}

function addRenderTasks(job, verified) {
    const settings = job.settings;
    const size = settings.render_chunk_size;
    frameChunker(settings.frames, size).forEach((frames, index) => {
        const task = author.Task(`render-${frames}`, "blender");
        task.addCommand(author.Command("blender-render", {
            exe: "{blender}",
            exeArgs: "{blenderArgs}",
            argsBefore: [],
            blendfile: settings.blendfile,
            args: filled(SHOT.render.args, settings, frames),
        }));
        // both divide the same list of frames: their places in it say which portions a render needs
        const first = Math.floor(index * size / settings.chunk_size);
        const last = Math.floor(((index + 1) * size - 1) / settings.chunk_size);
        for (const tasks of verified.slice(first, last + 1)) {
            for (const needed of tasks) {
                task.addDependency(needed);
            }
        }
        job.addTask(task);
    });
}

// Puts arguments together: each is a list of texts, of which every second one names a value of this task.
function filled(args, settings, frames) {
    const values = {
        frames: frames,
        all_frames: settings.frames,
        job_folder: settings.job_folder,
        cache: settings.cache,
        pictures: settings.pictures,
    };
    return args.map((parts) => parts.map((text, index) => index % 2 ? values[text] : text).join(""));
}
